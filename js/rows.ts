/** Describes each member of the contract once: the checks and the page's fields are made from these rows. */

/** How the page shows a member that the visitor can choose. */
export interface PageField {
  readonly group: "sample" | "method" | "weights" | "loop";
  readonly label: string;
  /** One sentence that explains the label. */
  readonly hint?: string;
  /** The member's name in links, if the last part of its path is already used there. */
  readonly link?: string;
  /** The initial value of the field, if it is not the default. */
  readonly initial?: number;
  /** The meaning of an empty field, if the default is neither a number nor a word. */
  readonly empty?: string;
  /** The part of the range that a slider spans; exponents of ten if it is logarithmic. */
  readonly slider?: { readonly min: number; readonly max: number; readonly step: number; readonly log?: boolean };
}

interface Common {
  /** The value if the member is absent; without a default it is derived from the data. */
  readonly default?: number | string | boolean;
  /** The words that are accepted instead of a number, each with its name on the page. */
  readonly words?: Readonly<Record<string, string>>;
}

/** A row that the page can show as a control. */
interface Shown extends Common {
  readonly page?: PageField;
}

/** A finite number, an integer, or a side of a raster in pixels, which has other error codes. */
export interface NumberRow extends Shown {
  readonly kind: "number" | "whole" | "side";
  readonly min?: number;
  readonly above?: number;
  readonly max?: number;
  readonly below?: number;
  readonly unit?: string;
}
export interface FlagRow extends Shown {
  readonly kind: "flag";
}
export interface WordRow extends Shown {
  readonly kind: "word";
  readonly words: Readonly<Record<string, string>>;
}
/** A list of this many numbers. */
export interface ListRow extends Common {
  readonly kind: "list";
  readonly length: number;
}
/** A square matrix: its numbers row after row in one list, or one list per row. */
export interface MatrixRow extends Common {
  readonly kind: "matrix";
  readonly side: number;
}
export interface ObjectRow extends Common {
  readonly kind: "object";
  /** A noun for the object with its article, such as "a pose". */
  readonly noun: string;
  readonly members: Rows;
  /** The required members. */
  readonly required?: readonly string[];
}

export type ShownRow = NumberRow | FlagRow | WordRow;
export type Row = ShownRow | ListRow | MatrixRow | ObjectRow;
export type Rows = Readonly<Record<string, Row>>;

type NumberList = ArrayLike<number>;
type Matrix = ArrayLike<NumberList>;
type Words<T> = Extract<T, string>;
type Kind<V> = [V] extends [never]
  ? WordRow
  : [V] extends [boolean]
    ? FlagRow
    : [V] extends [number]
      ? NumberRow
      : [V] extends [NumberList]
        ? ListRow
        : [V] extends [NumberList | Matrix]
          ? MatrixRow
          : ObjectRow & { readonly members: RowsOf<V> };

/** Lets the compiler compare a row with the type of its member: kind, words, and a valid default. */
export type RowOf<T> = Kind<Exclude<T, string>> &
  ([Words<T>] extends [never] ? unknown : { readonly words: Readonly<Record<Words<T>, string>> }) & {
    readonly default?: Extract<T, number | string | boolean>;
  };
/** A row for each member of a type; the compiler reports a missing one. */
export type RowsOf<T> = { readonly [K in keyof T]-?: RowOf<NonNullable<T[K]>> };

/** Every row, with the path of its member below `path`. */
export function* paths(rows: Rows, path: string): Generator<readonly [path: string, row: Row]> {
  for (const [name, row] of Object.entries(rows)) {
    const own = `${path}.${name}`;
    yield [own, row];
    if (row.kind === "object") yield* paths(row.members, own);
  }
}

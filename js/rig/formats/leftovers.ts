/**
 * Lenses and sizes beside their cameras: "rgbDistortion" beside "rgbIntrinsic", a section [image] beside that of the camera. Each is
 * assigned to the only camera to which it can belong, by its label or because there is no other; a warning names the rest.
 */
import { type ReaderWarning, warning } from "../warnings.js";
import { BROWN_NAMES, type RawCamera } from "./cameras.js";
import { isOfGroup } from "./groups.js";
import { modelIn } from "./stated.js";
import { isIntrinsics, isLens, isTranslation, member, rotationName, wordsOf } from "./names.js";
import { type Node, type Numbers, isNode, matrixOf, numberOf } from "./numbers.js";

/** An object with the objects around it. */
export interface Place {
  node: Node;
  parent: Place | undefined;
  depth: number;
  /** Whether the value is a list. */
  isList?: boolean;
}

/** A camera before it is checked, with its object. */
export interface FoundCamera {
  raw: RawCamera;
  label: string;
  place: Place;
}
type Coefficient = Pick<RawCamera, "model" | "isLens" | "isByName" | "isFourRadial"> & { distortion: Numbers };
interface Lens extends Coefficient {
  key: string;
  label: string;
  place: Place;
}
interface Size {
  key: string;
  label: string;
  place: Place;
  width: number;
  height: number;
}

/** Shortest side of an image, pixels; smaller sizes are those of boards and search windows. */
const SHORTEST_SIDE = 32;
/** Names of the list of coefficients of a lens. */
const LISTS = ["coefficients", "coeffs", "coefs", "params", "parameters", "values", "data", "d", "k"];
const NOT_OF_IMAGES = /\b(?:board|pattern|square|window|marker|grid|chessboard|tag|sensor|block|crop|roi)\b/;

/** Coefficients that are members, by OpenCV's names and in its order. */
export function coefficientsOf(node: Node): Coefficient | undefined {
  const singles = BROWN_NAMES.map((key) => numberOf(member(node, key)));
  if (singles.every((value) => value === undefined)) return undefined;
  const isThere = singles
    .map((value) => value !== undefined)
    .map(Number)
    .join("");
  return { distortion: singles.map((value) => value ?? 0), isByName: true, isFourRadial: isThere === "11001100" };
}

/** Coefficients in two lists, radial and tangential. */
function radialOf(node: Node): Numbers | undefined {
  const radial = matrixOf(member(node, "radial", "radialdistortion"))?.values;
  if (radial === undefined || radial.length > 6) return undefined;
  const [k1 = 0, k2 = 0, ...more] = radial;
  const [p1 = 0, p2 = 0] = matrixOf(member(node, "tangential", "tangentialdistortion"))?.values ?? [];
  return [k1, k2, p1, p2, ...more];
}

/** The coefficients and the model of a lens; undefined where the value is not a lens. */
function lensOf(value: unknown): Coefficient | undefined {
  const { values: listed, rows = 1 } = matrixOf(value) ?? {};
  // Rows of several numbers are a matrix, such as "T_c_d".
  if (listed !== undefined && rows > 1 && listed.length > rows) return undefined;
  if (listed !== undefined) return listed.length > 1 ? { distortion: listed } : undefined;
  if (!isNode(value)) return undefined;
  const coefficients = coefficientsOf(value);
  const distortion = coefficients?.distortion ?? radialOf(value) ?? matrixOf(member(value, ...LISTS))?.values;
  return distortion && { ...coefficients, distortion, ...modelIn(value) };
}

/** The two numbers of a list, or of a text such as "640x480". */
function sides(value: unknown): Numbers | undefined {
  const written = typeof value === "string" ? /^\s*(\d{1,5})\s*[x×*]\s*(\d{1,5})\s*$/.exec(value) : null;
  const both = written ? [Number(written[1]), Number(written[2])] : matrixOf(value)?.values;
  return both?.length === 2 && both.every((side) => Number.isInteger(side) && side >= SHORTEST_SIDE) ? both : undefined;
}

const WIDTH =
  /^(.*?) ?\b(?:image width|img width|image w|img w|img dist w|img width|width|w|cols|resolution x)\b ?(.*)$/;
const HEIGHTS: Record<string, string> = { width: "height", w: "h", cols: "rows", x: "y" };

/** The sizes that are members of an object: "width" with its "height", "image_size" and the like. */
function sizesOf(node: Node, place: Place): Size[] {
  const keys = Object.keys(node);
  const byWords = new Map(keys.map((key) => [wordsOf(key).join(" "), key]));
  const found: Size[] = [];
  for (const [words, key] of byWords) {
    const both = /\b(?:resolution|size|dimensions?)\b/.test(words) ? sides(node[key]) : undefined;
    const label = words.replace(/\b(?:image|img|resolution|size|dimensions?)\b/g, "").trim();
    if (both !== undefined) found.push({ key, label, place, width: both[0] ?? 0, height: both[1] ?? 0 });
    const each = /\b(?:resolution|size|dimensions?)s?\b/.test(words) ? node[key] : undefined;
    if (both === undefined && isNode(each))
      for (const [name, value] of Object.entries(each)) {
        const [width, height] = sides(value) ?? [];
        if (width !== undefined && height !== undefined)
          found.push({ key: `${key}.${name}`, label: wordsOf(name).join(" "), place, width, height });
      }
    const wide = WIDTH.exec(words);
    if (wide === null) continue;
    const other = words.replace(/\b(width|w|cols|x)\b(?!.*\b(?:width|w|cols|x)\b)/, (side) => HEIGHTS[side] ?? side);
    const [width, height] = [numberOf(node[key]), numberOf(node[byWords.get(other) ?? ""])];
    const size = sides([width, height]);
    if (size !== undefined)
      found.push({
        key,
        label: `${wide[1] ?? ""}${wide[2] ?? ""}`.trim(),
        place,
        width: width ?? 0,
        height: height ?? 0,
      });
  }
  return found.filter((size) => !NOT_OF_IMAGES.test(size.label));
}

/** Names that suggest a lens. */
const LENS_LIKE = /distort|dist_?coef|lens_?(?:coef|param)|^kc$|radial|tangential/i;

/** Possible numbers of coefficients of a lens, and the largest value of a coefficient. */
const [COUNTS, LARGEST] = [[4, 5, 8, 12, 14], 100];

/**
 * Whether a list may hold the coefficients of a lens, whatever its name. It must have a few fractions and must not be a pose or a
 * quaternion.
 */
function isLensLike(key: string, value: unknown): boolean {
  const { values = [], rows = 1 } = matrixOf(value) ?? {};
  const isList = COUNTS.includes(values.length) && (rows === 1 || rows === values.length);
  if (!isList || values.every(Number.isInteger) || values.some((each) => Math.abs(each) > LARGEST)) return false;
  const isUnit = values.length === 4 && Math.abs(Math.hypot(...values) - 1) < 1e-2;
  // Four numbers may be the intrinsics of a camera, but five are not.
  const isCamera = [4, 12].includes(values.length) && isIntrinsics(key) === "";
  return !isUnit && !isCamera && rotationName(key) === undefined && !isTranslation(key);
}

const isBelow = (place: Place | undefined, top: Place): boolean => {
  for (let each = place; each !== undefined; each = each.parent) if (each.node === top.node) return true;
  return false;
};

/** A label without words such as "camera", which do not distinguish cameras. */
const plainLabel = (label: string): string =>
  label
    .split(" ")
    .filter((word) => !/^(?:cam|camera|param|params|image|img)$/.test(word))
    .join(" ");
const isSame = (a: string, b: string): boolean => plainLabel(a) === plainLabel(b);

export class Leftovers {
  readonly #lenses: Lens[] = [];
  /** Lists whose numbers may be a lens of a camera that has none. */
  readonly #doubtful: { key: string; place: Place; distortion: Numbers }[] = [];
  /** Values whose names suggest a lens, but which no known program uses. */
  readonly #unknown: Pick<Lens, "key" | "distortion">[] = [];
  /** Objects that are lenses. */
  readonly #parts = new WeakSet<Node>();
  readonly #sizes: Size[] = [];

  /** Collects the members of an object that look like lenses or sizes; `used` are those that its cameras have taken. */
  collect(place: Place, used: ReadonlySet<string>): void {
    const { node } = place;
    for (const key of Object.keys(node)) {
      // Members of a group are collected when the walk reaches their group.
      if (isOfGroup(node, key)) continue;
      const label = used.has(key) ? undefined : isLens(key);
      const lens = label === undefined && !LENS_LIKE.test(key) ? undefined : lensOf(node[key]);
      if (label === undefined && lens === undefined && !used.has(key) && isLensLike(key, node[key]))
        this.#doubtful.push({ key, place, distortion: matrixOf(node[key])?.values ?? [] });
      if (label === undefined) {
        if (lens !== undefined && !used.has(key) && !this.#parts.has(node))
          this.#unknown.push({ key, distortion: lens.distortion });
        continue;
      }
      if (lens !== undefined && isNode(node[key])) this.#parts.add(node[key]);
      if (lens !== undefined) this.#lenses.push({ key, label, place, ...lens });
      else if (isNode(node[key])) this.#eachOf(node[key], key, place);
    }
    if (numberOf(node.rows) === undefined || node.data === undefined) this.#sizes.push(...sizesOf(node, place));
  }

  /** "distortion": { "color": [..], "depth": [..] } */
  #eachOf(node: Node, key: string, place: Place): void {
    for (const each of Object.keys(node)) {
      const lens = lensOf(node[each]);
      if (lens !== undefined)
        this.#lenses.push({ key: `${key}.${each}`, label: wordsOf(each).join(" "), place, ...lens });
    }
  }

  /** Gives cameras their lenses and sizes, and warns of those that belong to no camera. */
  assign(cameras: FoundCamera[], warnings: ReaderWarning[]): void {
    const unused = this.#lenses.filter((lens) => !this.#giveLens(lens, cameras));
    const isBare = ({ place }: { place: Place }) =>
      cameras.some(({ raw, place: own }) => own.node === place.node && raw.distortion === undefined);
    for (const { key, distortion } of [...unused, ...this.#unknown, ...this.#doubtful.filter(isBare)])
      if (distortion.some((value) => value !== 0))
        warnings.push(
          warning(
            "distortion-unused",
            `"${key}" looks like the distortion of a lens and was not used, because ${cameras.length === 0 ? "the file has no camera" : "the file does not give its camera"}. Write it into its camera.`,
            { name: key },
          ),
        );
    this.#giveSizes(cameras, warnings);
  }

  #giveLens(lens: Lens, cameras: FoundCamera[]): boolean {
    const below = cameras.filter(({ place }) => isBelow(place, lens.place));
    const alike = below.filter(({ label }) => isSame(label, lens.label));
    const among = [alike, lens.label === "" ? below : [], this.#lenses.length === 1 ? cameras : []];
    const camera = among.find((some) => some.length === 1)?.[0];
    if (camera === undefined || camera.raw.distortion !== undefined) return false;
    const { distortion, isByName, isFourRadial, isLens } = lens;
    Object.assign(camera.raw, { distortion, isByName, isFourRadial });
    if (lens.model !== undefined) Object.assign(camera.raw, { model: lens.model, isLens });
    return true;
  }

  #giveSizes(cameras: FoundCamera[], warnings: ReaderWarning[]): void {
    const isBare = ({ raw }: FoundCamera) => raw.width === undefined && raw.height === undefined;
    const give = ({ width, height }: Size, some: FoundCamera[]) => {
      for (const { raw } of some.filter(isBare)) Object.assign(raw, { width, height });
    };
    // The innermost sizes come first, so that cameras take the nearest one.
    const inner = [...this.#sizes].reverse();
    for (const size of inner)
      give(
        size,
        cameras.filter(({ place, label }) => isBelow(place, size.place) && isSame(label, size.label)),
      );
    for (const size of inner)
      if (plainLabel(size.label) === "")
        give(
          size,
          cameras.filter(({ place }) => isBelow(place, size.place)),
        );
    const others = this.#sizes.filter((size) => cameras.every(({ place }) => place.node !== size.place.node));
    const distinct = [...new Map(others.map((size) => [`${size.width}x${size.height}`, size])).values()];
    const [only] = distinct;
    const isOfAll = cameras.length === 1 || others.length === cameras.length;
    if (isOfAll && distinct.length === 1 && only !== undefined) give(only, cameras);
    if (!cameras.some(isBare) || distinct.length === 0) return;
    const sizes = distinct.slice(0, 4).map(({ key, width, height }) => `"${key}" (${width}x${height})`);
    warnings.push(
      warning(
        "size-unused",
        `The file has the size ${sizes.join(", ")}, but does not give its camera. Write width and height into each camera.`,
        { sizes: distinct.map(({ width, height }) => [width, height]) },
      ),
    );
  }
}

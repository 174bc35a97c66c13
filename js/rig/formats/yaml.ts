/**
 * YAML as programs write calibrations: blocks of mappings and sequences, flow collections, plain and quoted scalars, literal and folded
 * ones, comments, several documents, tags (left out), anchors and aliases. Scalars are those of YAML's core schema.
 *
 * Not read: keys that are not scalars ("? "), merge keys. Whatever it does not understand it refuses. Each character is looked at a
 * bounded number of times, and depth and aliases have limits, so that a small file cannot become a large value.
 *
 * By hand and not by js-yaml (5.5, 13 kB gzipped) or yaml (2.9, 30 kB): this is 2 kB, and everybody who checks a rig downloads it. The
 * tests compare it with js-yaml.
 */

const MOST_DEEP = 32;
const MOST_ALIASES = 64;

const isBlank = (c: string | undefined): boolean => c === undefined || c === " " || c === "\t" || c === "\n";
const ESCAPES: Record<string, string> = {
  0: "\0",
  a: "\x07",
  b: "\b",
  t: "\t",
  n: "\n",
  v: "\v",
  f: "\f",
  r: "\r",
  e: "\x1b",
  N: "\x85",
  _: "\xa0",
  L: "\u2028",
  P: "\u2029",
};
/** Digits of an escape by code. */
const CODES: Record<string, number> = { x: 2, u: 4, U: 8 };

/** A plain scalar's value. */
function plain(text: string): unknown {
  if (/^(?:~|null|Null|NULL|)$/.test(text)) return null;
  if (/^(?:true|True|TRUE)$/.test(text)) return true;
  if (/^(?:false|False|FALSE)$/.test(text)) return false;
  if (/^[-+]?(?:\.\d+|\d+(?:\.\d*)?)(?:[eE][-+]?\d+)?$/.test(text) || /^0(?:o[0-7]+|x[\da-fA-F]+)$/.test(text))
    return Number(text);
  if (/^[-+]?\.(?:inf|Inf|INF)$/.test(text)) return text.startsWith("-") ? -Infinity : Infinity;
  return /^\.(?:nan|NaN|NAN)$/.test(text) ? NaN : text;
}

/** Lines as one: an empty one is a line break, any other break a space. */
function folded(text: string): string {
  const lines = text.split("\n");
  let out = lines[0] ?? "";
  let breaks = 0;
  for (let at = 1; at < lines.length; at++) {
    if (at === 1) out = out.trimEnd();
    const isLast = at === lines.length - 1;
    const line = isLast ? (lines[at] ?? "").trimStart() : (lines[at] ?? "").trim();
    if (line === "" && !isLast) breaks++;
    else {
      out += ("\n".repeat(breaks) || " ") + line;
      breaks = 0;
    }
  }
  return out;
}

/** The words of a plain scalar on one line, in a flow collection and outside, and what lies between two lines of it. */
const FLOW_WORDS = /(?:[^\s:#,[\]{}]|:(?![\s,[\]{}]|$)|(?<!\s)#|[ \t]+(?![\s#:,[\]{}]|$))*/y;
const WORDS = /(?:[^\s:#]|:(?!\s|$)|(?<!\s)#|[ \t]+(?![\s#]|:\s|:$|$))*/y;
const GAP = /[ \t]*(?:\n[ \t]*)+(?=[^\s#])/y;
/** A tag, an anchor, an alias. */
const NAME = /[!&*][^\s,[\]{}]*/y;

class Reader {
  readonly #text: string;
  #at = 0;
  #deep = 0;
  #aliases = 0;
  #anchors = new Map<string, unknown>();

  constructor(text: string) {
    this.#text = text.replace(/\r\n?/g, "\n");
  }

  documents(): unknown[] {
    const all: unknown[] = [];
    for (;;) {
      this.#skip();
      while (this.#next === "%" && this.#column === 0) {
        this.#line();
        this.#skip();
      }
      const isMarked = this.#isMark("---");
      if (isMarked) this.#at += 3;
      else if (this.#next === undefined) return all;
      if (isMarked || !this.#isMark("...")) {
        [this.#anchors, this.#aliases] = [new Map(), 0];
        all.push(this.#node(0, true));
        this.#skip();
      }
      if (this.#isMark("...")) this.#at += 3;
      else if (this.#next !== undefined && !this.#isMark("---")) this.#fail("what stands here belongs to nothing");
    }
  }

  get #next(): string | undefined {
    return this.#text[this.#at];
  }

  get #column(): number {
    return this.#at - (this.#text.lastIndexOf("\n", this.#at - 1) + 1);
  }

  #fail(what: string): never {
    throw new Error(`${what}, line ${this.#text.slice(0, this.#at).split("\n").length}`);
  }

  /** Past what the sticky pattern matches here. */
  #take(pattern: RegExp): string | undefined {
    pattern.lastIndex = this.#at;
    const [found] = pattern.exec(this.#text) ?? [];
    this.#at += found?.length ?? 0;
    return found;
  }

  /** Past a tag or anchor; an anchor's name. */
  #property(): string | undefined {
    const word = this.#take(NAME) ?? "";
    return word.startsWith("&") ? word.slice(1) : undefined;
  }

  /** The rest of this line, and on to the next. */
  #line(): string {
    const end = this.#text.indexOf("\n", this.#at);
    const rest = this.#text.slice(this.#at, end < 0 ? undefined : end);
    this.#at = end < 0 ? this.#text.length : end + 1;
    return rest;
  }

  /** Past blanks, line breaks and comments; whether there was a break. */
  #skip(): boolean {
    let isBroken = false;
    for (;;) {
      const c = this.#next;
      if (c === "\n") isBroken = true;
      else if (c === "#" && isBlank(this.#text[this.#at - 1] ?? " ")) {
        const end = this.#text.indexOf("\n", this.#at);
        this.#at = end < 0 ? this.#text.length : end;
        continue;
      } else if (c === undefined || !isBlank(c)) return isBroken;
      this.#at++;
    }
  }

  #isMark(mark: string): boolean {
    return this.#column === 0 && this.#text.startsWith(mark, this.#at) && isBlank(this.#text[this.#at + 3]);
  }

  get #isOver(): boolean {
    return this.#next === undefined || this.#isMark("---") || this.#isMark("...");
  }

  /** "- ", "? " and ": ": a sign with a blank behind it. */
  #isSign(sign: string): boolean {
    return this.#next === sign && isBlank(this.#text[this.#at + 1]);
  }

  /** A node whose further lines begin at column `least` or beyond; a block may begin on this very line after a dash. */
  #node(least: number, mayBlock: boolean, ofMapping = false): unknown {
    if (++this.#deep > MOST_DEEP) this.#fail(`it is nested more than ${MOST_DEEP} deep`);
    let anchor: string | undefined;
    let [isBroken, properties] = [this.#skip(), 0];
    while (
      !this.#isOver &&
      (this.#next === "!" || this.#next === "&") &&
      (!isBroken || this.#column >= least) &&
      !this.#isKey(isBroken)
    ) {
      if (++properties > 2) this.#fail("nothing has more than a tag and an anchor");
      anchor = this.#property() ?? anchor;
      isBroken = this.#skip() || isBroken;
    }
    const value = this.#content(least, mayBlock || isBroken, isBroken, ofMapping);
    if (anchor !== undefined) this.#anchors.set(anchor, value);
    this.#deep--;
    return value;
  }

  #isKey(mayBlock: boolean): boolean {
    return mayBlock && this.#keyEnd() !== undefined;
  }

  #content(least: number, mayBlock: boolean, isBroken: boolean, ofMapping: boolean): unknown {
    const column = this.#column;
    if (this.#isOver) return null;
    // A mapping's sequence may begin in the column of its keys.
    if (isBroken && column < least && !(ofMapping && column === least - 1 && this.#isSign("-"))) return null;
    if (this.#isSign("-")) return mayBlock ? this.#sequence(column) : this.#fail("a sequence cannot begin here");
    if (this.#isSign("?")) this.#fail("keys after a question mark are not read here");
    if (mayBlock && this.#keyEnd() !== undefined) return this.#mapping(column);
    const c = this.#next;
    if (c === "|" || c === ">") return this.#block(least, c === ">");
    const value = this.#scalarOrFlow(least, false);
    this.#skip();
    return value;
  }

  #scalarOrFlow(least: number, inFlow: boolean): unknown {
    const c = this.#next;
    if (c === "[" || c === "{") return this.#flow(c === "{");
    if (c === '"' || c === "'") return this.#quoted(c);
    if (c === "*") return this.#alias();
    if (c === undefined || /[%@`|>\]},]/.test(c)) this.#fail(`nothing begins with ${c ?? "the end"}`);
    return plain(this.#words(least, inFlow));
  }

  #alias(): unknown {
    const name = (this.#take(NAME) ?? "").slice(1);
    if (++this.#aliases > MOST_ALIASES) this.#fail(`it has more than ${MOST_ALIASES} aliases`);
    if (!this.#anchors.has(name)) this.#fail(`there is no anchor ${name}`);
    return this.#anchors.get(name);
  }

  /** Where the key that begins here ends, if it is one: a scalar of this line with a colon behind it. */
  #keyEnd(): number | undefined {
    const quote = this.#next;
    const end = this.#text.indexOf("\n", this.#at);
    const line = this.#text.slice(this.#at, end < 0 ? undefined : end);
    if (quote === "[" || quote === "{" || quote === "#") return undefined;
    const pattern =
      quote === '"'
        ? /^"(?:[^"\\]|\\.)*"(?=[ \t]*:(?:[ \t]|$))/
        : quote === "'"
          ? /^'(?:[^']|'')*'(?=[ \t]*:(?:[ \t]|$))/
          : /^.*?(?=:(?:[ \t]|$))/;
    const [key] = pattern.exec(line) ?? [];
    return key === undefined || (quote !== '"' && quote !== "'" && /[ \t]#/.test(key))
      ? undefined
      : this.#at + key.length;
  }

  #key(end: number): string {
    const quote = this.#next;
    const value =
      quote === '"' || quote === "'"
        ? this.#quoted(quote)
        : this.#text
            .slice(this.#at, end)
            .replace(/^(?:[!&]\S+[ \t]+)+/, "")
            .trim();
    this.#at = this.#text.indexOf(":", end) + 1;
    return value;
  }

  #mapping(column: number): unknown {
    const entries = new Map<string, unknown>();
    while (!this.#isOver && this.#column === column) {
      const end = this.#keyEnd() ?? this.#fail("a key and a colon are missing");
      const key = this.#key(end);
      if (entries.has(key)) this.#fail(`the key ${key} is there twice`);
      entries.set(key, this.#node(column + 1, false, true));
      this.#skip();
    }
    if (!this.#isOver && this.#column > column) this.#fail("this line is indented too far");
    return Object.fromEntries(entries);
  }

  #sequence(column: number): unknown {
    const items: unknown[] = [];
    while (!this.#isOver && this.#column === column && this.#isSign("-")) {
      this.#at++;
      items.push(this.#node(column + 1, true));
      this.#skip();
    }
    if (!this.#isOver && this.#column > column) this.#fail("this line is indented too far");
    return items;
  }

  #flow(isMapping: boolean): unknown {
    if (++this.#deep > MOST_DEEP) this.#fail(`it is nested more than ${MOST_DEEP} deep`);
    const close = isMapping ? "}" : "]";
    const items: unknown[] = [];
    this.#at++;
    for (this.#skip(); this.#next !== close; this.#skip()) {
      const { key, value, isPair } = this.#entry();
      items.push(isMapping ? [String(key), isPair ? value : null] : isPair ? { [String(key)]: value } : value);
      this.#skip();
      if (this.#next === ",") this.#at++;
      else if (this.#next !== close) this.#fail(`a comma or ${close} is missing`);
    }
    this.#at++;
    this.#deep--;
    return isMapping ? Object.fromEntries(items as [string, unknown][]) : items;
  }

  /** One of a flow collection: a value, or a key with one. */
  #entry(): { key: unknown; value: unknown; isPair: boolean } {
    const isQuoted = this.#next === '"' || this.#next === "'";
    const key = this.#flowValue();
    this.#skip();
    if (
      this.#next !== ":" ||
      !(isQuoted || isBlank(this.#text[this.#at + 1]) || /[,[\]{}]/.test(this.#text[this.#at + 1] ?? ""))
    )
      return { key, value: key, isPair: false };
    this.#at++;
    this.#skip();
    const isEmpty = /[,}\]]/.test(this.#text[this.#at] ?? "");
    return { key, value: isEmpty ? null : this.#flowValue(), isPair: true };
  }

  #flowValue(): unknown {
    let anchor: string | undefined;
    while (this.#next === "!" || this.#next === "&") {
      anchor = this.#property() ?? anchor;
      this.#skip();
    }
    const value = this.#scalarOrFlow(0, true);
    if (anchor !== undefined) this.#anchors.set(anchor, value);
    return value;
  }

  #quoted(quote: string): string {
    const start = ++this.#at;
    for (; ; this.#at++) {
      const c = this.#next;
      if (c === undefined) this.#fail("a quote is missing");
      if (c === "\\" && quote === '"') this.#at++;
      else if (c === quote && quote === "'" && this.#text[this.#at + 1] === "'") this.#at++;
      else if (c === quote) break;
    }
    const inside = this.#text.slice(start, this.#at++);
    if (quote === "'") return folded(inside).replaceAll("''", "'");
    return folded(inside.replace(/\\\n[ \t]*/g, "")).replace(
      /\\(?:x[\da-fA-F]{2}|u[\da-fA-F]{4}|U[\da-fA-F]{8}|[^])/g,
      (escape) => this.#escaped(escape.slice(1)),
    );
  }

  #escaped(code: string): string {
    const letter = code.slice(0, 1);
    if (CODES[letter] === undefined)
      return ESCAPES[letter] ?? (/[ "/\\\t]/.test(letter) ? letter : this.#fail(`there is no escape \\${letter}`));
    const point = Number.parseInt(code.slice(1), 16);
    return code.length === 1 || point > 0x10ffff ? this.#fail("an escape is damaged") : String.fromCodePoint(point);
  }

  /** A plain scalar's words, over as many lines as it has. */
  #words(least: number, inFlow: boolean): string {
    let text = "";
    for (;;) {
      const words = this.#take(inFlow ? FLOW_WORDS : WORDS) ?? "";
      text += words;
      if (text === "") this.#fail("nothing that is read here stands here");
      const back = this.#at;
      const gap = this.#take(GAP);
      if (gap === undefined) return text;
      const goesOn =
        !this.#isOver &&
        (inFlow ? !/[,[\]{}:]/.test(this.#next ?? "") : this.#column >= least && this.#keyEnd() === undefined);
      if (!goesOn) {
        this.#at = back;
        return text;
      }
      text += folded(gap);
    }
  }

  /** A literal or folded scalar: the lines that are indented from column `least` on. */
  #block(least: number, isFolded: boolean): string {
    const head =
      /^[|>]([-+]?)([1-9]?)([-+]?)[ \t]*(?:#.*)?$/.exec(this.#line()) ?? this.#fail("the head of a text is damaged");
    const chomp = head[1] || head[3];
    const lines: string[] = [];
    let indent = head[2] ? Math.max(0, least - 1) + Number(head[2]) : undefined;
    while (this.#next !== undefined && !this.#isOver) {
      const start = this.#at;
      const line = this.#line();
      const own = /^ */.exec(line)?.[0].length ?? 0;
      if (line.trim() === "" && own <= (indent ?? own)) {
        lines.push("");
        continue;
      }
      indent ??= own;
      if (own < Math.max(indent, least)) {
        this.#at = start;
        break;
      }
      lines.push(line.slice(indent));
    }
    let last = lines.length;
    while (last > 0 && lines[last - 1] === "") last--;
    const body = lines.slice(0, last).join("\n");
    const end = chomp === "-" || body === "" ? "" : chomp === "+" ? "\n".repeat(lines.length - last + 1) : "\n";
    return (isFolded ? body.replace(/(\S)\n(?=\S)/g, "$1 ").replace(/\n(\n+)/g, "$1") : body) + end;
  }
}

/** The documents of a text. */
export const readDocuments = (text: string): unknown[] => new Reader(text).documents();

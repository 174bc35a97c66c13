/**
 * The subset of XML in which OpenCV and ROS launch files are written: elements, attributes, text, comments. Written here because
 * fast-xml-parser (5.12, 20 kB gzipped and seven packages) reads much more, including entities, which these files never have. This reader
 * refuses documents that declare entities.
 */
import { badFile } from "../../errors.js";

export interface Element {
  tag: string;
  attributes: Record<string, string>;
  children: Element[];
  text: string;
}

/** Largest depth of nested elements; calibrations are less deep. */
const MOST_DEPTH = 32;
const MOST_ELEMENTS = 100_000;
/** Largest number of characters of a tag with its attributes. */
const MOST_TAG = 4096;

const ENTITIES: Record<string, string> = { lt: "<", gt: ">", amp: "&", quot: '"', apos: "'" };
const plain = (text: string): string =>
  text.replace(/&(lt|gt|amp|quot|apos);/g, (_, name: string) => ENTITIES[name] ?? "");

function attributesOf(text: string): Record<string, string> {
  const found: Record<string, string> = Object.create(null);
  for (const [, name = "", double, single] of text.matchAll(/([\w:.-]+)\s*=\s*(?:"([^"]*)"|'([^']*)')/g))
    found[name] = plain(double ?? single ?? "");
  return found;
}

/** The place where `what` occurs next, or an error. */
function after(text: string, what: string, from: number): number {
  const at = text.indexOf(what, from);
  if (at < 0) throw badFile(`this XML is cut off: a ${JSON.stringify(what)} is missing`);
  return at + what.length;
}

/** The end of a tag, beyond its attributes, which may hold a ">". */
function tagEnd(text: string, from: number): number {
  let quote = "";
  for (let at = from; at < text.length; at++) {
    if (at - from > MOST_TAG) throw badFile(`this XML has a tag of more than ${MOST_TAG} characters`);
    const letter = text[at] ?? "";
    if (quote !== "") quote = letter === quote ? "" : quote;
    else if (letter === '"' || letter === "'") quote = letter;
    else if (letter === ">") return at + 1;
  }
  throw badFile("this XML is cut off within a tag");
}

export function readXml(text: string): Element {
  const root: Element = { tag: "", attributes: {}, children: [], text: "" };
  const open = [root];
  const pieces: string[][] = [[]];
  let count = 0;
  for (let at = 0; at < text.length; ) {
    const tag = text.indexOf("<", at);
    if (tag < 0) break;
    pieces.at(-1)?.push(text.slice(at, tag));
    if (text.startsWith("<?", tag)) at = after(text, "?>", tag);
    else if (text.startsWith("<!--", tag)) at = after(text, "-->", tag);
    else if (text.startsWith("<!", tag))
      throw badFile(
        "this XML declares a document type or raw data, which is not supported, because no calibration needs it",
      );
    else {
      const end = tagEnd(text, tag);
      const inner = text.slice(tag + 1, end - 1);
      at = end;
      if (inner.startsWith("/")) {
        const name = inner.slice(1).trim();
        const last = open.length > 1 ? open.pop() : undefined;
        if (last?.tag !== name) throw badFile(`this XML closes <${name.slice(0, 40)}>, which is not open`);
        last.text = plain((pieces.pop() ?? []).join(" ")).trim();
        continue;
      }
      const empty = inner.endsWith("/");
      const name = /^[\w:.-]+/.exec(inner)?.[0];
      if (name === undefined) throw badFile("this XML has a tag without a name");
      const element: Element = {
        tag: name,
        attributes: attributesOf(inner.slice(name.length)),
        children: [],
        text: "",
      };
      open.at(-1)?.children.push(element);
      if (++count > MOST_ELEMENTS) throw badFile(`this XML has more than ${MOST_ELEMENTS} elements`);
      if (empty) continue;
      open.push(element);
      pieces.push([]);
      if (open.length > MOST_DEPTH) throw badFile(`this XML is nested deeper than ${MOST_DEPTH}`);
    }
  }
  const last = open.at(-1);
  if (last !== undefined && last !== root) throw badFile(`this XML is cut off: <${last.tag}> is not closed`);
  return root;
}

/** Elements as plain values: those with children as objects (repeated ones and OpenCV's <_> as lists), others as their text. */
export function plainXml(element: Element): unknown {
  if (element.children.length === 0) return element.text;
  if (element.children.every((child) => child.tag === "_")) return element.children.map(plainXml);
  const all = new Map<string, unknown[]>();
  for (const child of element.children) {
    const values = all.get(child.tag);
    if (values) values.push(plainXml(child));
    else all.set(child.tag, [plainXml(child)]);
  }
  const found: Record<string, unknown> = Object.create(null);
  for (const [tag, values] of all) found[tag] = values.length === 1 ? values[0] : values;
  return found;
}

// What a report must be: whole, and without anything that could run or ask for a file.
import assert from "node:assert/strict";

/** Elements with no end of their own. */
const VOID = new Set(["meta", "img", "!doctype"]);
/** Attributes that may name another file. */
const ADDRESSES = /^(?:src|srcset|href|xlink:href|action|formaction|data|poster|background|ping)$/;

/** The elements of a page that keeps to quoted attributes: their names and attributes, and the text; it asserts that every one is closed. */
function parse(page) {
  const elements = [];
  const open = [];
  let text = "";
  const token = /<(\/?)([!a-z][a-z0-9]*)((?:\s+[a-z][\w:-]*(?:="[^"]*")?)*)\s*(\/?)>|([^<]+)|(<)/gi;
  for (const [, end, name, attributes, self, words, stray] of page.matchAll(token)) {
    assert.equal(stray, undefined, "a bracket that is no element");
    if (words !== undefined) text += words;
    else if (end) assert.equal(open.pop(), name, `</${name}> closes another element`);
    else {
      const found = Object.fromEntries(
        [...attributes.matchAll(/([\w:-]+)(?:="([^"]*)")?/g)].map(([, key, value = ""]) => [key, value]),
      );
      elements.push({ name: name.toLowerCase(), attributes: found });
      if (!self && !VOID.has(name.toLowerCase())) open.push(name);
    }
  }
  assert.deepEqual(open, []);
  return { elements, text };
}

/** Fails where a page could run or ask for anything. */
export function harmless(page) {
  const { elements, text } = parse(page);
  for (const { name, attributes } of elements) {
    assert.ok(!["script", "link", "iframe", "object", "embed", "base", "form", "use", "a"].includes(name), `<${name}>`);
    for (const [key, value] of Object.entries(attributes)) {
      assert.ok(!key.startsWith("on") && key !== "style", `${name} ${key}`);
      if (ADDRESSES.test(key)) assert.match(value, /^data:image\//);
    }
  }
  const [style] = /<style>[^<]*<\/style>/.exec(page);
  assert.ok(!/@import|url\(/i.test(style));
  return { elements, text };
}

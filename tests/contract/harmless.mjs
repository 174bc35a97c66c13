// Requirements on a report: it is complete, and contains nothing that could run or request a file.
import assert from "node:assert/strict";

/** Elements without an end tag. */
const VOID = new Set(["meta", "img", "!doctype"]);
/** Attributes that can name another file. */
const ADDRESSES = /^(?:src|srcset|href|xlink:href|action|formaction|data|poster|background|ping)$/;

/** Parses a page that quotes all attributes: returns element names, attributes and text, and asserts that every element is closed. */
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

/** Fails if a page could run or request anything. */
export function harmless(page) {
  const { elements, text } = parse(page);
  for (const { name, attributes } of elements) {
    assert.ok(!["script", "link", "iframe", "object", "embed", "base", "form", "a"].includes(name), `<${name}>`);
    for (const [key, value] of Object.entries(attributes)) {
      assert.ok(!key.startsWith("on") && key !== "style", `${name} ${key}`);
      // A drawing may repeat a part of the page itself.
      if (ADDRESSES.test(key)) assert.match(value, name === "use" ? /^#[\w-]+$/ : /^data:image\//);
    }
  }
  const [style] = /<style>[^<]*<\/style>/.exec(page);
  assert.ok(!/@import|url\(/i.test(style));
  return { elements, text };
}

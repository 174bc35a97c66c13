// Edits the features that a compiled module declares to the tools that run after the linker.

const CUSTOM = 0;
const MAGIC = 8;

/** An unsigned LEB128 number at `at`, and the position after it. */
function number(bytes, at) {
  let [value, shift] = [0, 0];
  for (;;) {
    const byte = bytes[at++];
    value |= (byte & 0x7f) << shift;
    if (byte < 0x80) return [value >>> 0, at];
    shift += 7;
  }
}

function encoded(value) {
  const bytes = [];
  for (; value >= 0x80; value >>>= 7) bytes.push((value & 0x7f) | 0x80);
  return [...bytes, value];
}

/** A name with its length in front, and the position after it. */
function name(bytes, at) {
  const [length, start] = number(bytes, at);
  return [bytes.toString("utf8", start, start + length), start + length];
}

/** The module without one entry of its section "target_features", which declares what it was compiled for. */
export function withoutFeature(module, feature) {
  const parts = [module.subarray(0, MAGIC)];
  for (let at = MAGIC; at < module.length; ) {
    const [size, start] = number(module, at + 1);
    const end = start + size;
    const [title, first] = module[at] === CUSTOM ? name(module, start) : [];
    parts.push(title === "target_features" ? without(module, start, first, feature) : module.subarray(at, end));
    at = end;
  }
  return Buffer.concat(parts);
}

/** That section, rebuilt: its title, the number of entries, and each entry as a sign and a name. */
function without(module, start, first, feature) {
  const [count, begin] = number(module, first);
  const entries = [];
  for (let at = begin, left = count; left > 0; left--) {
    const [named, next] = name(module, at + 1);
    if (named !== feature) entries.push(module.subarray(at, next));
    at = next;
  }
  const body = Buffer.concat([module.subarray(start, first), Buffer.from(encoded(entries.length)), ...entries]);
  return Buffer.concat([Buffer.from([CUSTOM, ...encoded(body.length)]), body]);
}

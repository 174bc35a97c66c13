/** The arithmetic of xacro's `${..}`: numbers, properties, pi, + - * /, brackets, radians() and degrees(). */
const TOKEN = /\s*(?:(\d+\.?\d*(?:e[-+]?\d+)?|\.\d+(?:e[-+]?\d+)?)|([A-Za-z_][\w.:]*)|([-+*/()]))/iy;
const MOST_TOKENS = 200;
const MOST_NESTED = 20;

function tokensOf(text: string): string[] | undefined {
  const tokens: string[] = [];
  TOKEN.lastIndex = 0;
  while (TOKEN.lastIndex < text.trimEnd().length) {
    const found = TOKEN.exec(text);
    if (found === null || tokens.length > MOST_TOKENS) return undefined;
    tokens.push(found[0].trim());
  }
  return tokens;
}

/** The value; undefined where a name has no value or the text is not an expression. */
export function evaluate(text: string, valueOf: (name: string) => number | undefined): number | undefined {
  const tokens = tokensOf(text);
  if (tokens === undefined) return undefined;
  let at = 0;
  let depth = 0;
  const sum = (): number => {
    let value = product();
    while (tokens[at] === "+" || tokens[at] === "-")
      value = tokens[at++] === "+" ? value + product() : value - product();
    return value;
  };
  const product = (): number => {
    let value = factor();
    while (tokens[at] === "*" || tokens[at] === "/") value = tokens[at++] === "*" ? value * factor() : value / factor();
    return value;
  };
  const bracket = (): number => {
    if (tokens[at++] !== "(" || ++depth > MOST_NESTED) return NaN;
    const value = sum();
    depth--;
    return tokens[at++] === ")" ? value : NaN;
  };
  const factor = (): number => {
    const token = tokens[at] ?? "";
    if (token === "-" || token === "+") {
      if (++depth > MOST_NESTED) return NaN;
      at++;
      const value = factor();
      depth--;
      return token === "-" ? -value : value;
    }
    if (token === "(") return bracket();
    at++;
    if (/^[\d.]/.test(token)) return Number(token);
    const name = token.replace(/^math\./, "");
    if (tokens[at] === "(") {
      const scale = { radians: Math.PI / 180, degrees: 180 / Math.PI }[name];
      return scale === undefined ? NaN : scale * bracket();
    }
    return /^(?:pi|M_PI)$/.test(name) ? Math.PI : (valueOf(name) ?? NaN);
  };
  const value = sum();
  return at === tokens.length && Number.isFinite(value) ? value : undefined;
}

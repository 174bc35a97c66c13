// Notices as text: the authors of an artefact's contents, and the licences.
/** The file's name in every artefact; a browser shows the file as text. */
export const NOTICES = "THIRD-PARTY-NOTICES.txt";
const RULE = "=".repeat(80);

/** A line of a section's list: name and version, then the licence. */
const listed = ({ name, version, licence }) => `  ${name} ${version}, ${licence}`;

const byName = (a, b) => (a.name < b.name ? -1 : a.name > b.name ? 1 : a.version < b.version ? -1 : 1);

/**
 * A section: its title, the list of its packages, then every text once, below the names of all packages that it applies to.
 * An entry is `{ name, version, licence, texts }`.
 */
export function section(title, entries) {
  const sorted = [...entries].sort(byName);
  const owners = new Map();
  for (const { name, version, texts } of sorted)
    for (const text of texts.map(tidy)) owners.set(text, [...(owners.get(text) ?? []), `${name} ${version}`]);
  const texts = [...owners].map(([text, names]) => `${RULE}\n${wrapped(names)}\n${RULE}\n\n${text}\n`);
  return `${title}\n\n${sorted.map(listed).join("\n")}\n\n${texts.join("\n")}`;
}

/** The packages in the lists of a text, as "name version". */
export const namedIn = (text) => [...text.matchAll(/^ {2}(\S+ \d\S*), .+$/gm)].map((match) => match[1]);

/** Line ends and surrounding white space differ between copies of a licence and are not significant. */
const tidy = (text) =>
  text
    .replaceAll("\r\n", "\n")
    .replaceAll(/[ \t]+$/gm, "")
    .replace(/^\n+|\s+$/g, "");

/** Names joined by commas, in lines of at most 80 characters. */
function wrapped(names) {
  const lines = [""];
  for (const name of names) {
    const last = lines.at(-1);
    if (last !== "" && last.length + name.length > 77) lines.push(name);
    else lines[lines.length - 1] = last === "" ? name : `${last}, ${name}`;
  }
  return lines.join(",\n");
}

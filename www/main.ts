/** Brings the page to life: the Lab and the controls around it. */

import { byId, make } from "./dom";
import { listenToKeys } from "./keys";
import { Lab } from "./lab/lab";
import { paces } from "./lab/player";
import { fromLink, type Origin } from "./lab/settings";
import { linkTo } from "./lab/share";
import { themeToggle } from "./theme";

const button = (id: string, action: () => void): void => byId(id, HTMLButtonElement).addEventListener("click", action);

const lab = new Lab();
const { player, store, gallery } = lab;
const help = byId("help", HTMLDialogElement);
const phone = matchMedia("(max-width: 45rem)");

const openHelp = () => help.showModal();
const step = () => void player.step("step");
const stage = () => void player.step("stage");
const reset = () => void lab.restart();
const undo = () => store.undo();

button("play", () => player.toggle());
button("step", step);
button("stage-step", stage);
button("reset", reset);
button("undo", undo);
button("defaults", () => store.resetToDefaults());
button("export", () => lab.download());
button("help-button", openHelp);
button("link", () => void copyLink());
themeToggle(byId("theme", HTMLButtonElement), () => gallery.recolour());

const pace = byId("pace", HTMLSelectElement);
pace.append(...paces.map(({ label }, i) => make("option", { value: i }, label)));
pace.value = String(player.pace);
pace.addEventListener("change", () => (player.pace = Number(pace.value)));

function choose(origin: Origin): void {
  for (const each of ["sample", "files"] as const) {
    byId(`origin-${each}`, HTMLButtonElement).setAttribute("aria-pressed", String(each === origin));
    byId(`${each}-panel`, HTMLElement).hidden = each !== origin;
  }
  lab.choose(origin);
}
button("origin-sample", () => choose("sample"));
button("origin-files", () => choose("files"));

/** Where the clipboard is closed to pages, the address bar holds the same link. */
async function copyLink(): Promise<void> {
  const target = byId("link", HTMLButtonElement);
  try {
    await navigator.clipboard.writeText(linkTo(store.settings));
    target.textContent = "Copied";
  } catch {
    target.textContent = "See address bar";
  }
  setTimeout(() => (target.textContent = "Link"), 2000);
}

const views = Array.from({ length: gallery.count }, (_, i): [string, () => void] => [String(i + 1), () => gallery.enlarge(i + 1)]);
listenToKeys({
  " ": () => player.toggle(),
  s: step,
  t: stage,
  r: reset,
  u: undo,
  "?": openHelp,
  Escape: () => gallery.enlarge(null),
  ...Object.fromEntries(views),
});

// A file dropped beside its slot must not replace the page.
for (const type of ["dragover", "drop"]) document.addEventListener(type, (event) => event.preventDefault());

byId("input", HTMLDetailsElement).open = !phone.matches;
// A link opened in this very tab changes nothing but the part after #.
addEventListener("hashchange", () => store.change(fromLink(location.hash)));
void lab.begin();

/** Starts the page: its parts, the Lab, and the controls around it. */

import { byId, make, nextFrame, nextTask } from "./dom";
import { isFirstVisit } from "./first-visit";
import { keepPlaying } from "./kiosk";
import { areKeysOn, listenToKeys, rememberKeys } from "./keys";
import { Form } from "./lab/form";
import { Gallery } from "./lab/gallery";
import { Lab } from "./lab/lab";
import { paces } from "./lab/player";
import { Presets } from "./lab/presets";
import { kinds } from "./lab/kinds";
import { defaults, fromLink, type Origin, type Settings } from "./lab/settings";
import { linkTo, onLook, showLooks, writeAddress } from "./lab/share";
import { wasOwn } from "./lab/source";
import { reword } from "./reword";
import { saves } from "./save";
import { Store } from "./lab/store";
import { asksToPlay, isEmbedded, placeOf, type Place } from "./place";

import { keepForOffline } from "./offline/offline";
import { themeToggle, wearTheme } from "./theme";
import { phrase } from "./words";

const button = (id: string, action: () => void): void => byId(id, HTMLButtonElement).addEventListener("click", action);

wearTheme();
// The Lab, the controls around it and the first picture are separate tasks, laid out one after the other, so that no click waits for the
// whole start. The first task shows the parts that were hidden in the first layout, which loads the fonts.
await nextFrame();
document.body.removeAttribute("data-opening");
await nextFrame();
const store = new Store(placeOf(location.hash) === "lab" ? fromLink(location.hash) : defaults);
const form = new Form(store);
form.mount();
await nextFrame();
const gallery = new Gallery();
await nextFrame();
const lab = new Lab({ store, form, gallery });
const { player } = lab;
await nextTask();
const help = byId("help", HTMLDialogElement);

/** A part of the page beside the Lab. */
interface Elsewhere {
  open(hash: string): void;
  leave(): void;
  recolour(): void;
  download(): void | Promise<void>;
}
type OtherPlace = Exclude<Place, "lab">;

/** The places, each loaded on its first use. */
const loaders: Record<OtherPlace, () => Promise<new (main: HTMLElement) => Elsewhere>> = {
  learn: async () => (await import("./learn/learn")).Learn,
  tables: async () => (await import("./tables/page")).TablesPage,
  rig: async () => (await import("./rig/page")).RigPage,
};
const others: Partial<Record<OtherPlace, Elsewhere>> = {};

/** The topic of the part that is open. */
function openHelp(): void {
  const place = placeOf(location.hash);
  byId("help-title", HTMLElement).textContent = place === "lab" ? "The Lab" : places[place].link.textContent;
  for (const part of help.querySelectorAll<HTMLElement>("[data-place]")) part.hidden = part.dataset.place !== place;
  help.showModal();
}

const step = () => void player.step("step");
const stage = () => void player.step("stage");
const reset = () => void lab.restart();
const undo = () => store.undo();
const redo = () => store.redo();

// The address holds the settings, so the links themselves do not navigate.
for (const [id, target] of [
  ["skip", "#play"],
  ["skip-takeaway", "#takeaway button"],
] as const) {
  byId(id, HTMLAnchorElement).addEventListener("click", (event) => {
    event.preventDefault();
    document.querySelector<HTMLButtonElement>(target)?.focus();
  });
}
button("play", () => player.toggle());
button("step", step);
button("stage-step", stage);
button("reset", reset);
button("undo", undo);
button("redo", redo);
button("defaults", () => store.resetToDefaults());
button("export", () => void exportResults());
async function exportResults(): Promise<void> {
  const place = placeOf(location.hash);
  let isSaved = false;
  const note = (event: Event) => {
    isSaved = true;
    say("export", phrase("saved", "Saved"));
    if (event instanceof CustomEvent) report(phrase("saved.as", "Saved {what}.", { what: String(event.detail) }));
  };
  saves.addEventListener("saved", note);
  try {
    await (place === "lab" ? lab : others[place])?.download();
  } finally {
    saves.removeEventListener("saved", note);
  }
  if (!isSaved) say("export", phrase("export.nothing", "Nothing to export"));
}
button("help-button", openHelp);
button("link", () => void copyLink());
themeToggle(byId("theme", HTMLButtonElement), () => {
  void gallery.recolour();
  others.learn?.recolour();
  others.tables?.recolour();
  others.rig?.recolour();
});

const pace = byId("pace", HTMLSelectElement);
pace.append(...paces.map(({ label }, i) => make("option", { value: i }, label)));
pace.value = String(player.pace);
pace.addEventListener("change", () => (player.pace = Number(pace.value)));

/** Shows for a moment, on the button that was pressed, how the action ended. */
function say(id: string, words: string): void {
  const target = byId(id, HTMLButtonElement);
  reword(target);
  target.textContent = words;
  setTimeout(() => reword(target), 2000);
}

/** Says below the buttons of the top what was saved. */
function report(words: string): void {
  const place = byId("exported", HTMLElement);
  place.textContent = words;
  clearTimeout(fading);
  fading = setTimeout(() => (place.textContent = ""), 8000);
}
let fading: ReturnType<typeof setTimeout> | undefined;

function choose(origin: Origin): void {
  for (const each of ["sample", "files"] as const) {
    byId(`origin-${each}`, HTMLButtonElement).setAttribute("aria-pressed", String(each === origin));
    byId(`${each}-panel`, HTMLElement).hidden = each !== origin;
  }
  lab.choose(origin);
  showExample();
}
const isSample = (): boolean => byId("files-panel", HTMLElement).hidden !== false;
const examples = new Presets(
  byId("presets", HTMLElement),
  (settings) => {
    if (!isSample()) choose("sample");
    // Another example is first seen from the default viewpoint, however the last one was rotated.
    gallery.lookAnew();
    void start(settings);
  },
  // After a press the current example has the focus; Space then plays or pauses, as elsewhere.
  () => player.toggle(),
);
const showExample = () => examples.show(store.settings, isSample());
store.listen(() => {
  byId("undo", HTMLButtonElement).disabled = !store.canUndo;
  byId("redo", HTMLButtonElement).disabled = !store.canRedo;
  showExample();
});
showExample();

const still = matchMedia("(prefers-reduced-motion: reduce)");
/** The run of these settings, which plays by itself unless the visitor prefers reduced motion. */
const start = (settings: Settings): Promise<void> => (still.matches ? lab.enter(settings) : lab.watch(settings));

button("origin-sample", () => choose("sample"));
button("origin-files", () => choose("files"));

/** If the page may not use the clipboard, the address bar holds the same link. */
async function copyLink(): Promise<void> {
  try {
    await navigator.clipboard.writeText(location.href);
    const isBare = placeOf(location.hash) === "lab" && !isSample();
    say("link", isBare ? "Copied without files" : phrase("copied", "Copied"));
  } catch {
    say("link", phrase("copy.address", "Copy the address bar"));
  }
}

const places: Record<Place, { main: HTMLElement; link: HTMLAnchorElement; title: string }> = {
  lab: { main: byId("lab", HTMLElement), link: byId("to-lab", HTMLAnchorElement), title: "bimodal-stereo" },
  learn: {
    main: byId("learn", HTMLElement),
    link: byId("to-learn", HTMLAnchorElement),
    title: "Learn, bimodal-stereo",
  },
  tables: {
    main: byId("tables", HTMLElement),
    link: byId("to-tables", HTMLAnchorElement),
    title: "Tables, bimodal-stereo",
  },
  rig: {
    main: byId("rig", HTMLElement),
    link: byId("to-rig", HTMLAnchorElement),
    title: "Check a rig, bimodal-stereo",
  },
};
/** Controls of the Lab outside its own part of the page. */
const labOnly = [byId("bar", HTMLElement), byId("skip", HTMLElement), byId("skip-takeaway", HTMLElement)];

function show(place: Place): void {
  // A message about a file that was saved in another part of the page is removed.
  if (document.body.dataset.place !== place) report("");
  document.body.dataset.place = place;
  for (const [name, { main, link, title }] of Object.entries(places)) {
    main.hidden = name !== place;
    if (name === place) {
      link.setAttribute("aria-current", "page");
      document.title = title;
    } else {
      link.removeAttribute("aria-current");
    }
  }
  for (const element of labOnly) element.hidden = place !== "lab";
}

let arrived = false;
/** The address says which part is shown, and with which settings. */
async function arrive(): Promise<void> {
  const place = placeOf(location.hash);
  // A visitor who comes from another part of the page, or by a link with settings, did not come for a demonstration.
  const opensFirst = !arrived && location.hash === "" && isFirstVisit();
  arrived = true;
  document.documentElement.toggleAttribute("data-embed", isEmbedded(location.hash));
  show(place);
  if (place !== "learn") others.learn?.leave();
  if (place !== "tables") others.tables?.leave();
  if (place !== "rig") others.rig?.leave();
  if (place !== "lab") {
    lab.leave();
    // The address always keeps the #, because without it the page would reload.
    places.lab.link.href = new URL(linkTo(store.settings)).hash || "#";
    await open(place);
    return;
  }
  const settings = fromLink(location.hash);
  const { hash } = location;
  if (!asksToPlay(hash)) {
    const entered = opensFirst ? start(settings) : lab.enter(settings);
    showLooks(hash);
    // Parts of the address that are not settings, or name an unknown setting, were ignored.
    if (hash !== "") writeAddress(store.settings);
    return entered;
  }
  if (!isSample()) choose("sample");
  gallery.lookAnew();
  const started = lab.watch(settings);
  writeAddress(store.settings);
  await started;
}

async function open(place: OtherPlace): Promise<void> {
  const { main, link } = places[place];
  const loaded = await loaders[place]().catch((error: unknown) => {
    main.textContent = `${link.textContent} could not be loaded: ${error instanceof Error ? error.message : String(error)}`;
  });
  // A visitor who has moved on in the meantime is not brought back.
  if (!loaded || placeOf(location.hash) !== place) return;
  if (!others[place]) main.replaceChildren();
  others[place] ??= new loaded(main);
  others[place].open(location.hash);
}

// If this part is already open, nothing changes, and its settings are kept.
for (const [name, { link }] of Object.entries(places)) {
  link.addEventListener("click", (event) => {
    if (placeOf(location.hash) === name) event.preventDefault();
  });
}

const views = Array.from({ length: Math.min(10, gallery.count) }, (_, i): [string, () => void] => [
  String((i + 1) % 10),
  () => gallery.enlarge(i + 1),
]);
const keys = byId("keys-on", HTMLInputElement);
keys.checked = areKeysOn();
keys.addEventListener("change", () => rememberKeys(keys.checked));
const press = (id: string) => () => byId(id, HTMLButtonElement).click();
listenToKeys(() => keys.checked && placeOf(location.hash) === "lab", {
  // These keys press the buttons, which are disabled while there is nothing to run.
  " ": press("play"),
  s: press("step"),
  t: press("stage-step"),
  r: press("reset"),
  u: undo,
  y: redo,
  "?": openHelp,
  Escape: () => gallery.enlarge(null),
  ...Object.fromEntries(views),
});

// A dropped file must not replace the page; dropped anywhere on the Lab, it goes into the slot for its content.
const showDrag = (isOver: boolean) => byId("lab", HTMLElement).toggleAttribute("data-over", isOver);
document.addEventListener("dragover", (event) => {
  event.preventDefault();
  showDrag(event.dataTransfer?.types.includes("Files") ?? false);
});
document.addEventListener("dragleave", (event) => {
  if (event.relatedTarget === null) showDrag(false);
});
document.addEventListener("drop", () => showDrag(false), { capture: true });
document.addEventListener("drop", (event) => {
  event.preventDefault();
  const files = [...(event.dataTransfer?.files ?? [])];
  if (files.length === 0 || placeOf(location.hash) !== "lab") return;
  // The short path shows the new files by itself.
  if (!document.querySelector("dialog.first-run[open]")) drawer.open = true;
  if (isSample()) choose("files");
  void lab.own.drop(files);
});
button("own-pictures", () => {
  if (isSample()) choose("files");
  const playing = { play: () => player.playing || player.toggle(), isSample, choose: () => choose("files") };
  void import("./lab/ownpath").then(({ openPath }) => openPath(lab.own, store, playing));
});

for (const each of document.querySelectorAll<HTMLButtonElement>("#takeaway button")) {
  const kind = kinds.find((kind) => kind === each.value);
  if (kind) each.addEventListener("click", () => void lab.take(kind));
}

const drawer = byId("input", HTMLDetailsElement);
function closeDrawer(): void {
  drawer.open = false;
  drawer.querySelector("summary")?.focus();
}
drawer.addEventListener("keydown", (event) => {
  if (event.key !== "Escape" || !drawer.open) return;
  event.stopPropagation();
  closeDrawer();
});
// After a reload the visitor's own files are open again.
if (placeOf(location.hash) === "lab" && wasOwn() && !asksToPlay(location.hash)) {
  arrived = true;
  choose("files");
}
onLook(() => writeAddress(store.settings));
// On small screens the settings cover the button that opened them.
button("close-settings", closeDrawer);
// On phones the settings cover the results of a run.
const phone = matchMedia("(max-width: 45rem)");
button("play", () => {
  if (phone.matches && player.playing) drawer.open = false;
});
// A link opened in this tab changes only the part of the address after #. The browser reports it twice: at once, and again later, when the
// address may have changed again.
let told = "";
addEventListener("popstate", () => {
  told = location.href;
  void arrive();
});
addEventListener("hashchange", ({ newURL }) => {
  if (newURL !== told) void arrive();
  told = "";
});
await nextTask();
keepPlaying({
  isPlaying: () => player.playing,
  play: (hash, isTouched) => {
    if (placeOf(hash) === "learn") {
      // Lessons keep settings, guesses and the place in the text, which only a new page forgets.
      if (!isTouched) return;
      history.replaceState(null, "", hash);
      return location.reload();
    }
    // With "play" the new address differs from the present one, from which that word is removed as soon as the run plays.
    location.hash = placeOf(hash) === "lab" && !asksToPlay(hash) ? [hash || "#", "play"].join("&") : hash;
  },
});
void arrive();
void keepForOffline(byId("offline", HTMLElement));

/** The Lab: settings in, frames out. It connects the parts and holds the state of one experiment. */

import { byId, nextFrame, nextTask } from "../dom";
import { Engine, EngineError, LOST } from "../engine/engine";
import type { Frame, LabOptions, Opened, Source } from "../engine/protocol";
import type { StepReport } from "../../pkg/index.js";
import { Explanations } from "./ask";
import type { Form } from "./form";
import type { Gallery } from "./gallery";
import { OwnFiles } from "./ownfiles";
import { Compare } from "./compare";
import { Player, type Advance, type Again } from "./player";
import { offerPictures } from "./pictures";
import { Panels } from "./panels";
import { RunRecord } from "./record";
import { repeated } from "./repeat";
import { areOfInput } from "./fields";
import { guess, methodOf, runOptions, settingsOf, startNear, turnOf, type Origin, type Settings } from "./settings";
import { download, writeAddress } from "./share";
import { belongings, namesIn, objectOf, originOf, readable, rememberOrigin, sourceOf } from "./source";
import { handOver } from "./handover";
import type { Store } from "./store";
import { Transport } from "./transport";
import { LightTrial } from "./trial";
import type { Kind } from "./kinds";
import { Messages } from "./messages";
import { Notices } from "./notices";
import { fill, sayVacant, vacate } from "./vacancy";
import { verdict, wordsOf, type Verdict } from "./verdict";

const offerViews = () => offerPictures(byId("lab", HTMLElement), byId("take-picture", HTMLSelectElement));

export class Lab {
  readonly store: Store;
  readonly gallery: Gallery;
  readonly player = new Player({
    advance: (request) => this.#advance(request),
    restart: () => this.#start(this.#wanted),
    isFinished: () => this.#record.isFinished,
    isSearching: (by) => this.#record.isSearching(by),
    onChange: () => this.#showState(),
    onError: (error, again) => void this.#breakOff(error, again),
  });
  readonly #engine = new Engine({
    onLoad: (bytes) => {
      if (!this.#record.report)
        this.#notices.announce("loading", `loading the numerics, ${Math.round(bytes / 1000)} kB`);
    },
    onLost: (error) => this.#lose(error),
  });
  readonly #form: Form;
  /** The visitor's files. */
  readonly own = new OwnFiles({
    onChange: () => {
      this.#saved = undefined;
      void this.#reopen();
    },
    settings: () => this.store.settings,
    onFields: (fields, isFollowed) => (isFollowed ? this.store.adopt(fields) : this.store.change(fields)),
    onRun: (file) => this.#goOnWith(file),
    onDoubt: () => this.#showState(),
    onLooking: (names) => typeof this.#wanted === "string" && this.#notices.lack(this.#wanted, names),
  });
  /** A saved run that replaces a pair of files, until a pair is given. */
  #saved: Source | undefined;
  /** The files of the input on the screen; empty for a sample. */
  #pair: readonly (File | undefined)[] = [];
  readonly #panels: Panels;
  readonly #compare: Compare;
  readonly #transport = new Transport();
  readonly #light: LightTrial;
  readonly #notices = new Notices(() => this.#showState());
  readonly #messages: Messages;
  #origin: Origin = "sample";
  readonly #record = new RunRecord();
  /** The input that was requested last, accepted or not; for an incomplete input, the missing parts. */
  #wanted: Source | string = "";
  /** The input on the screen, to be opened again if the worker has lost it. */
  #good: { source: Source; settings: Settings } | undefined;
  /** The input that the worker holds. It may have been superseded before it was shown. */
  #held: Source | undefined;
  /** Counts the runs that were begun, so that answers to a superseded one are dropped. */
  #turn = 0;
  /** The run that is being begun; steps wait for it. */
  #beginning: Promise<void> = Promise.resolve();
  /** The object whose surfaces are on the screen. */
  #seen = "";
  #offered = false;
  /** Whether the input is played once it has been opened. */
  #willPlay = false;
  /** Whether the run has been replayed because its worker had ended. */
  #resumed = false;
  /** Whether the run continues when the visitor returns from another part of the page. */
  #goesOn = false;

  constructor({ store, form, gallery }: { store: Store; form: Form; gallery: Gallery }) {
    this.store = store;
    this.#form = form;
    this.gallery = gallery;
    this.#messages = new Messages(this.#form, this.own.intake, () => void this.own.drawMask());
    const unlessGone = (): undefined => undefined;
    gallery.serve({
      look: (look) => this.#engine.call("look", { look }).catch(unlessGone),
      probe: (asked) => this.#engine.call("probe", asked).catch(unlessGone),
    });
    this.#compare = new Compare({
      onPin: () => this.#pin(),
      onUnpin: () => this.gallery.unpin(),
      onWipe: (share) => this.gallery.wipe(share),
    });
    this.#panels = new Panels(new Explanations(() => methodOf(this.store.settings, this.#origin)), {
      rivals: {
        onLook: (pose) => {
          gallery.pretend(pose);
          this.#showState();
        },
        onStart: ({ angles }) => store.change(startNear(angles), true),
      },
      light: {
        turn: () => turnOf(this.store.settings),
        onLight: (patch, done, gesture) => this.#light.change(patch, done, gesture),
      },
    });
    this.#light = new LightTrial({
      ...{ store, gallery, engine: this.#engine, panels: this.#panels },
      turn: () => (this.#origin === "sample" ? this.#turn : undefined),
    });
    byId("slots", HTMLElement).append(this.own.intake.element);
    byId("take-picture", HTMLSelectElement).addEventListener("focus", () => offerViews());
    this.store.listen((settings, changed, live) => this.#settingsChanged(settings, changed, live));
    this.#form.adapt(this.store.settings, this.#origin);
  }

  /** Shows these settings. The first settings open their input in any case, and a run that was playing when the visitor left continues. */
  enter(settings: Settings): Promise<void> {
    const [before, goesOn] = [this.#turn, this.#goesOn];
    this.#goesOn = false;
    this.store.change(settings);
    if (before === 0) return this.#reopen();
    if (goesOn && before === this.#turn && !this.#record.isFinished) void this.#playOnce(this.#beginning);
    return this.#beginning;
  }

  /** Plays the run of these settings from its beginning. */
  watch(settings: Settings): Promise<void> {
    const before = this.#turn;
    const entered = this.enter(settings);
    return this.#playOnce(before === this.#turn ? this.restart() : entered);
  }

  /** Pauses, because the visitor has gone to another part of the page. */
  leave(): void {
    this.#goesOn ||= this.player.playing || this.#willPlay;
    this.#willPlay = false;
    this.player.pause();
  }

  /** Switches between samples and own files; the last input stays on the screen until there is a new one. */
  choose(origin: Origin): void {
    this.#origin = origin;
    rememberOrigin(origin);
    this.#form.adapt(this.store.settings, origin);
    void this.#reopen();
    this.own.choose(origin);
  }

  restart(): Promise<void> {
    this.player.pause();
    return this.#start(this.#wanted);
  }

  download(): void {
    const { truth, report, history } = this.#record;
    if (!this.#good || !report) return;
    download({ ...this.#good, source: originOf(this.#good.source), truth, report, history });
  }

  /** Returns one of the results at full resolution. */
  async take(kind: Kind): Promise<void> {
    const { report, truth } = this.#record;
    if (!this.#good || !report) return;
    const files = this.#good.source.kind === "files" ? this.own.intake.said : [];
    try {
      await handOver(kind, this.#engine, { ...this.#good, report, truth, end: this.#verdict(report), files });
    } catch (error) {
      await this.#fail(error);
    }
  }

  /** Opens a saved run, which is repeated up to the point that it had reached. */
  #goOnWith(file: File): void {
    this.player.pause();
    this.#saved = { kind: "saved", file };
    this.own.intake.remarks("files", [
      { words: `${file.name}: a saved run, resumed where it stopped. Its options are in the fields.`, wrong: false },
    ]);
    this.#vacate();
    void this.#start(this.#saved);
  }

  /** Removes the pictures and true values of the previous pair from the screen. */
  #vacate(): void {
    this.#good = undefined;
    this.#record.clear();
    this.#messages.note({});
    this.#pair = [];
    this.#compare.release();
    this.#forget();
    vacate();
  }

  #settingsChanged(settings: Settings, changed: readonly string[], live: boolean): void {
    writeAddress(settings);
    this.#form.adapt(settings, this.#origin);
    this.own.adapt(settings);
    // Settings of a run that already exists.
    if (changed.length === 0) return;
    this.#panels.date(true);
    // A slider shows its effect: a run that was playing, is about to play or had ended is played again.
    const again = live && (this.player.playing || this.#willPlay || this.#record.isFinished);
    const begun = areOfInput(changed) ? this.#reopen() : this.restart();
    if (again) void this.#playOnce(begun);
  }

  #pin(): void {
    this.gallery.pin(this.#record.history);
    this.#compare.say(this.#record.report ? wordsOf(this.#record.report, this.#record.truth) : "");
  }

  /** Plays a run once it has begun, unless it has been superseded by then. */
  async #playOnce(begun: Promise<void>): Promise<void> {
    const turn = this.#turn;
    this.#willPlay = true;
    await begun;
    if (this.#turn !== turn || !this.#willPlay) return;
    this.#willPlay = false;
    if (!this.player.playing && !this.#notices.now) this.player.toggle();
  }

  #reopen(): Promise<void> {
    this.player.pause();
    const { colour, depth } = this.own.intake.files;
    const wanted = this.#origin === "files" && !this.#saved ? [colour, depth] : [];
    if (wanted.length !== this.#pair.length || wanted.some((file, i) => file !== this.#pair[i])) this.#vacate();
    return this.#start(
      this.#origin === "files" && this.#saved
        ? this.#saved
        : sourceOf(this.#origin, this.store.settings, this.own.intake.files),
    );
  }

  /** Starts the loop; the worker may already hold its input. */
  #start(source: Source | string): Promise<void> {
    this.#willPlay = false;
    return this.#enter(this.#attempt(source, ++this.#turn));
  }

  #enter(beginning: Promise<void>): Promise<void> {
    return (this.#beginning = beginning);
  }

  async #attempt(source: Source | string, turn: number): Promise<void> {
    this.#wanted = source;
    this.#resumed = false;
    this.#messages.clear();
    if (typeof source === "string") return this.#notices.lack(source);
    const settings = this.store.settings;
    const options = runOptions(settings, originOf(source));
    const isAgain = source === this.#good?.source;
    this.#notices.announce("loading", isAgain ? "restarting" : "reading the input", isAgain ? "" : namesIn(source));
    try {
      await this.#offerChoices();
      await this.#engine.interrupt();
      if (turn !== this.#turn) return;
      if (this.#held === source && source === this.#good?.source) {
        const frame = await this.#engine.call("reset", { options, look: this.gallery.look });
        if (turn !== this.#turn) return;
        this.#forget();
        await this.#show(frame);
      } else if (!(await this.#open(source, options, turn))) return;
      // Includes the values that the page has filled in by itself.
      this.#good = { source, settings: turn === this.#turn ? this.store.settings : settings };
      if (turn === this.#turn) this.#notices.settle();
    } catch (error) {
      if (turn === this.#turn) await this.#fail(error);
    }
  }

  async #offerChoices(): Promise<void> {
    if (this.#offered) return;
    await this.#notices.loading("loading the numerics", async () => {
      // Creating the worker's thread blocks the page, so it is a separate task.
      await nextTask();
      const { surfaces, lights } = await this.#engine.call("catalogue", {});
      this.#form.offer("surface", surfaces);
      this.#form.offer("light", lights);
      this.#offered = true;
    });
  }

  /** Has the worker open an input and shows it, unless it has been superseded by then. */
  async #open(source: Source, options: LabOptions, turn: number): Promise<boolean> {
    const input = await readable(source, (words) => turn === this.#turn && this.#notices.detail(words));
    if (turn !== this.#turn) return false;
    const request = { source: input, options, look: this.gallery.look };
    const opened = await this.#engine.call("open", request, belongings(input));
    this.#held = source;
    if (turn !== this.#turn) return false;
    if (input.kind === "pair" && source.kind === "files" && source.files.unit === undefined)
      this.store.complete(guess("unit", input.pair.unit));
    this.#pair = source.kind === "files" ? [source.files.colour, source.files.depth] : [];
    await this.#present(opened);
    return true;
  }

  /** Pictures are drawn in one frame and numbers in the next, so that no click waits for the layout of both. */
  async #present(opened: Opened): Promise<void> {
    const turn = this.#turn;
    fill();
    const object = objectOf(this.#wanted, this.store.settings);
    await this.gallery.open(opened, object === "" || object !== this.#seen);
    this.#seen = object;
    await nextTask();
    if (turn !== this.#turn) return;
    this.#forget();
    this.#record.truth = opened.truth;
    this.#record.length = opened.units.image;
    this.#panels.light.showTruth(opened.trueLight);
    if (opened.options) this.store.adopt(settingsOf(opened.options));
    this.#messages.note(opened.notes);
    this.#take(opened.frame);
    await nextFrame();
    offerViews();
  }

  async #advance(request: Advance): Promise<boolean> {
    await this.#beginning;
    // While files are still missing, the pair on the screen is not the requested one.
    if (typeof this.#wanted === "string") return false;
    if (!this.#good) await this.#start(this.#wanted);
    if (!this.#good || this.#record.isFinished) return false;
    const turn = this.#turn;
    if (request.by === "stage") this.#panels.run();
    try {
      const frame = await this.#engine.call("advance", { ...request, look: this.gallery.look });
      if (turn !== this.#turn) return false;
      await this.#show(frame);
    } catch (error) {
      // A change in the meantime has already started a new run.
      if (turn !== this.#turn) return false;
      throw error;
    }
    if (turn === this.#turn) this.#notices.settle();
    return !this.#record.isFinished;
  }

  /** Clears the record and the panels of the last run. */
  #forget(): void {
    this.#record.restart();
    this.#panels.clear();
  }

  #show(frame: Frame): Promise<void> {
    this.#take(frame);
    return this.gallery.show(frame, this.#record.history);
  }

  #take(frame: Frame): void {
    this.#record.add(frame.reports);
    this.#panels.take(frame, this.#record);
    this.#showState();
  }

  #verdict(report: StepReport): Verdict | undefined {
    const isHeld = methodOf(this.store.settings, this.#origin).registration === "fixed";
    return verdict(report, this.#record.from, this.#record.truth, isHeld, this.#origin === "files");
  }

  #showState(): void {
    const { playing } = this.player;
    const { report } = this.#record;
    this.#panels.about(this.#origin, this.own.doubt);
    this.#panels.show(this.#record, playing, report && this.#verdict(report));
    const notice = this.#notices.now;
    if (notice) this.#panels.announce(notice);
    // The reported problem prevents a run, unless an earlier run stays usable.
    const isIdle = typeof this.#wanted === "string" || !this.#good;
    sayVacant(this.#wanted, notice);
    this.#transport.show(playing, isIdle && notice?.cause ? notice.words : "");
  }

  /** Shows an error beside the field that it concerns; the run on the screen stays usable. */
  async #fail(error: unknown): Promise<void> {
    this.player.pause();
    this.#notices.fail(this.#messages.fail(error));
    if (this.#good && this.#held !== this.#good.source) await this.#recover(this.#good);
  }

  /** The worker's input is lost. If no caller has reported the loss after all rejections have been handled, it is reported here. */
  #lose(error: EngineError): void {
    this.#held = undefined;
    const turn = this.#turn;
    const act = () => {
      if (turn !== this.#turn || !this.#good || this.#held) return;
      const reached = error.code === LOST && this.#record.report;
      void this.#enter(reached ? this.#repeat(this.#good, reached) : this.#fail(error));
    };
    if (error.fatal) setTimeout(act);
  }

  /** The browser ended the worker while the page rested: the run is repeated, and nothing on the screen changes. */
  async #repeat(good: { source: Source; settings: Settings }, reached: StepReport): Promise<void> {
    const turn = ++this.#turn;
    const isWanted = () => turn === this.#turn;
    try {
      const frame = await repeated(good, reached, this.#engine, this.gallery, isWanted);
      if (!frame) return;
      this.#held = good.source;
      await this.gallery.show(frame, this.#record.history);
    } catch (error) {
      if (isWanted()) await this.#fail(error);
    }
  }

  /** Repeats a run or a step whose worker was ended, with the same numbers; only once, because the run itself may be the cause. */
  async #breakOff(error: unknown, again: Again | undefined): Promise<void> {
    const reached = this.#record.iteration;
    const failed = this.#enter(this.#fail(error));
    const turn = this.#turn;
    await failed;
    const isLost = error instanceof EngineError && error.code === LOST;
    if (!again || !isLost || this.#resumed || turn !== this.#turn || !this.#good || this.player.playing) return;
    this.#resumed = true;
    again(() => this.#record.iteration >= reached);
  }

  /** The worker has lost its input, for example after a panic, so the same input is opened again from its beginning. */
  async #recover({ source, settings }: { source: Source; settings: Settings }): Promise<void> {
    const turn = ++this.#turn;
    try {
      if (!(await this.#open(source, runOptions(settings, originOf(source)), turn))) return;
      this.#good = { source, settings };
      this.#messages.add("The input is kept; the run restarts.");
    } catch (error) {
      if (turn !== this.#turn) return;
      this.#good = undefined; // The page waits for another input.
      this.#messages.add(error instanceof Error ? error.message : String(error), true);
    }
  }
}

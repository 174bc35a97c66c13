/** A live connection to a robot: takes a frame of each new view and runs the check after each frame. */

import type { Topic } from "./recordings";
import type { Assembly } from "./protocol";
import { type Session, wasCancelled } from "./session";
import { type Item, type RigState, messageOf } from "./state";
import { whole } from "./words";

/** Largest number of views that are taken; more views of one rig add little. */
const MOST = 10;

export type LiveState = "off" | "connecting" | "connected" | "looking" | "checking" | "done" | "lost";

interface Watched extends RigState {
  readonly session: Session;
  readonly missing: string[];
  reserve(count: number): number;
  join(assembly: Assembly, recording?: Item): void;
  check(onProgress: (share: number, message: string) => void): Promise<void>;
}

/** The precision of the result after each number of views. */
export interface Step {
  views: number;
  verdict: string;
  pixels: number;
  interval: [number, number];
}

export class Live {
  state: LiveState = "off";
  address = "";
  /** The name of the server. */
  name = "";
  topics: Topic[] = [];
  chosen = { colour: "", depth: "" };
  /** The message of the last error. */
  error = "";
  progress = "";
  steps: Step[] = [];
  readonly #rig: Watched;
  /** The item that the frames belong to; they are removed with it. */
  #item: Item | undefined;
  /** Counts connections and runs, so that late answers of older ones are ignored. */
  #turn = 0;
  #isStopping = false;

  constructor(rig: Watched) {
    this.#rig = rig;
  }

  get isRunning(): boolean {
    return this.state === "looking" || this.state === "checking";
  }

  get views(): number {
    return this.#rig.items.filter(({ recording }) => recording === this.#item?.id).filter(isDepth).length;
  }

  #become(state: LiveState, error = ""): void {
    this.state = state;
    this.error = error;
    this.#rig.changed();
  }

  async connect(address: string): Promise<void> {
    const turn = ++this.#turn;
    this.address = address;
    this.#become("connecting");
    try {
      const { name, topics, chosen } = await this.#rig.session.call("connect", { address });
      if (turn !== this.#turn) return;
      Object.assign(this, { name, topics, chosen: { colour: "", depth: "", ...chosen } });
      this.#become("connected");
      void this.#untilClosed(turn);
    } catch (error) {
      if (turn === this.#turn) this.#become("lost", messageOf(error));
    }
  }

  async #untilClosed(turn: number): Promise<void> {
    const reason = await this.#rig.session.call("closed", {}).catch(messageOf);
    if (turn === this.#turn) this.#lose(reason);
  }

  /** The views taken so far stay and are checked. */
  #lose(reason: string): void {
    this.#turn++;
    this.#become("lost", `The connection to ${this.address} was lost: ${reason}.`);
  }

  choose(chosen: Partial<Live["chosen"]>): void {
    this.chosen = { ...this.chosen, ...chosen };
    this.#rig.changed();
  }

  /** Takes views until there are enough, it is stopped, or the connection is lost. */
  async start(): Promise<void> {
    const turn = ++this.#turn;
    const isMine = () => turn === this.#turn;
    this.#isStopping = false;
    void this.#untilClosed(turn);
    try {
      while (!this.#isStopping && this.views < MOST) {
        this.#become("looking");
        const first = this.#rig.reserve(4);
        const assembly = await this.#rig.session.call("observe", { first, ...this.chosen, fresh: this.views === 0 });
        if (!isMine()) return;
        this.#take(assembly);
        await this.#check();
        if (!isMine()) return;
      }
      this.#become(this.#isStopping ? "connected" : "done");
    } catch (error) {
      // If the connection was lost, the reason has already been shown.
      if (isMine()) this.#become("connected", this.#isStopping || wasCancelled(error) ? "" : messageOf(error));
    }
  }

  #take({ cameras, poses, warnings, ...assembly }: Assembly): void {
    const isFirst = this.views === 0;
    const item = (this.#item = isFirst ? this.#list() : (this.#item ?? this.#list()));
    const said = new Set(this.#rig.notes.map(({ code }) => code));
    this.#rig.join(
      {
        ...assembly,
        cameras: isFirst ? cameras : [],
        poses: isFirst ? poses : [],
        warnings: warnings.filter(({ code }) => !said.has(code)),
      },
      item,
    );
  }

  /** Adds the robot to the list of files. */
  #list(): Item {
    const says = `${this.name || "a robot"}, ${this.chosen.colour} and ${this.chosen.depth}`;
    const summary = { kind: "robot" as const, says, warnings: [], guessed: [], cameras: [], poses: [] };
    const item: Item = { id: this.#rig.freshId(), name: this.address, state: "read", summary };
    this.#rig.items.push(item);
    this.steps = [];
    return item;
  }

  async #check(): Promise<void> {
    if (this.#rig.missing.length > 0) return;
    this.#become("checking");
    await this.#rig.check((_, message) => {
      this.progress = message;
      this.#rig.changed();
    });
    const { run } = this.#rig;
    if (!run) return;
    const { verdict: capped, code } = whole(run);
    const verdict = run.estimateOnly ? "estimated" : code === "doubtful" ? code : capped;
    this.steps.push({ views: this.views, verdict, ...run.report.health });
  }

  /** The connection stays open, and a running check continues to its end. */
  stop(): void {
    this.#isStopping = true;
    void this.#rig.session.call("rest", {}).catch(() => {});
  }

  disconnect(): void {
    this.#turn++;
    void this.#rig.session.call("disconnect", {}).catch(() => {});
    this.#become("off");
  }
}

const isDepth = ({ summary }: Item): boolean => summary?.kind === "depth";

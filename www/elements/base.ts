/** What both elements share. The package is also imported where there is no document, such as a server that renders React. */

import type { ElementError } from "../../pkg/elements.js";

const Nothing = class {} as unknown as typeof HTMLElement;

export abstract class Base extends (globalThis.HTMLElement ?? Nothing) {
  #error: ElementError | undefined;
  #isScheduled = false;

  get error(): ElementError | undefined {
    return this.#error;
  }

  connectedCallback(): void {
    // Properties may have been set before the class was known, by React or before an upgrade of the element.
    for (const name of this.settable) {
      if (!Object.hasOwn(this, name)) continue;
      const value: unknown = Reflect.get(this, name);
      Reflect.deleteProperty(this, name);
      Reflect.set(this, name, value);
    }
    this.restart();
  }

  disconnectedCallback(): void {
    this.stop();
  }

  /** Restarts once for all changes of one task. */
  restart(): void {
    if (this.#isScheduled || !this.isConnected) return;
    this.#isScheduled = true;
    queueMicrotask(() => {
      this.#isScheduled = false;
      this.stop();
      this.#error = undefined;
      if (this.isConnected) this.start();
    });
  }

  /** Whether a restart is scheduled, which will read all attributes. */
  protected get isScheduled(): boolean {
    return this.#isScheduled;
  }

  protected abstract readonly settable: readonly string[];
  /** Ends the worker. */
  protected abstract stop(): void;
  protected abstract start(): void;

  protected fail(error: ElementError): void {
    this.#error = error;
    this.tell("error", error);
  }

  protected forgive(): void {
    this.#error = undefined;
  }

  protected tell(type: string, detail: unknown): void {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }

  protected text(name: string): string {
    return this.getAttribute(name) ?? "";
  }

  protected write(name: string, value: string | undefined | null): void {
    if (value === undefined || value === null || value === "") this.removeAttribute(name);
    else this.setAttribute(name, String(value));
  }
}

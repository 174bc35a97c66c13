/**
 * Writes the state of the page into the browser's address, except over an address that was asked for in the meantime: a closed dialog and a
 * finished drawing report later than a link or the Back button changes the address, and the page opens the new one soon after.
 */
export class Address {
  #known = "";

  /** Takes the present address as the one that the page shows. */
  read(): void {
    this.#known = location.hash;
  }

  /** Replaces the present entry of the browser's history, or adds another. */
  write(hash: string, entry: "same" | "another" = "same"): void {
    if (location.hash !== this.#known) return;
    if (entry === "same") history.replaceState(null, "", hash);
    else history.pushState(null, "", hash);
    this.read();
  }
}

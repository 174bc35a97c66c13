/** The page on a stand: with ?kiosk in its address it plays by itself again once nobody has touched it for a while. */

/** Seconds without input, unless the address states another number, as ?kiosk=30 does. */
const SILENCE = 60;
const TOUCHES = ["pointermove", "pointerdown", "keydown", "wheel"] as const;

export interface Stand {
  isPlaying(): boolean;
  /** Returns to the first state of this address, whatever part of the page is shown. If this part has a run, it is played. */
  play(hash: string, isTouched: boolean): void;
}

export function keepPlaying({ isPlaying, play }: Stand): void {
  const asked = new URLSearchParams(location.search).get("kiosk");
  if (asked === null) return;
  const { hash } = location;
  const seconds = Number(asked) > 0 ? Number(asked) : SILENCE;
  let last = performance.now();
  let isTouched = false;
  const note = () => (last = performance.now());
  const touched = () => {
    isTouched = true;
    note();
  };
  for (const touch of TOUCHES) addEventListener(touch, touched, { passive: true });
  setInterval(() => {
    if (isPlaying()) note();
    if (performance.now() - last < 1000 * seconds) return;
    note();
    play(hash, isTouched);
    isTouched = false;
  }, 500);
}

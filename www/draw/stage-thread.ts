/** The thread that draws the clouds: a page that waits for its own WebGL drawing answers nobody meanwhile. */

import { Stage, type Change } from "./stage";

let stage: Stage | undefined;

/** First the canvas, then changes; each is answered once it is drawn, the canvas by whether there is WebGL. */
self.onmessage = ({ data }: MessageEvent<OffscreenCanvas | Change>) => {
  if (data instanceof OffscreenCanvas) {
    try {
      stage = new Stage(data);
      self.postMessage(true);
    } catch {
      self.postMessage(false);
    }
    return;
  }
  self.requestAnimationFrame(() => {
    stage?.show(data);
    self.postMessage(true);
  });
};

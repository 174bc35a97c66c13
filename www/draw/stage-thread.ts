/** The thread that draws the clouds: a page that waits for its own WebGL drawing answers no press meanwhile. */

import { CloudStage, type Change } from "./stage";

let stage: CloudStage | undefined;

/** First the canvas, then changes; each is answered once it is drawn, the canvas by whether there is WebGL. */
self.onmessage = ({ data }: MessageEvent<OffscreenCanvas | Change>) => {
  if (data instanceof OffscreenCanvas) {
    try {
      stage = new CloudStage(data);
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

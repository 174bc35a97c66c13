/** The thread that draws the clouds: a page that waits for its own WebGL drawing answers no press meanwhile. */

import "../engine/hold";
import { CloudStage, type Change, type Told } from "./stage";

let stage: CloudStage | undefined;
const tell = (told: Told): void => self.postMessage(told);

/** First the canvas, then changes. */
self.onmessage = ({ data }: MessageEvent<OffscreenCanvas | Change>) => {
  if (data instanceof OffscreenCanvas) {
    try {
      stage = new CloudStage(data, (lost) => tell({ lost }));
      tell(true);
    } catch {
      tell(false);
    }
    return;
  }
  self.requestAnimationFrame(() => {
    stage?.show(data);
    tell(true);
  });
};

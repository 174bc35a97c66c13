/** The thread that draws the clouds, because WebGL drawing on the page would block it. */

import "../engine/hold";
import { CloudStage, type Asked, type Told } from "./stage";

let stage: CloudStage | undefined;
const tell = (told: Told): void => self.postMessage(told);

self.onmessage = ({ data }: MessageEvent<Asked>) => {
  if (data === "can you draw?") {
    tell(new OffscreenCanvas(1, 1).getContext("webgl2") !== null);
    return;
  }
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

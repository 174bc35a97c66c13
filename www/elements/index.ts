/** Defines both custom elements. Where there is no document, importing it does nothing. */

import { BimodalFigure } from "./figure";
import { BimodalStereo } from "./stereo";

export { configure } from "./threads";

if (typeof customElements !== "undefined") {
  // A page may load two copies of the package.
  if (!customElements.get("bimodal-stereo")) customElements.define("bimodal-stereo", BimodalStereo);
  if (!customElements.get("bimodal-figure")) customElements.define("bimodal-figure", BimodalFigure);
}

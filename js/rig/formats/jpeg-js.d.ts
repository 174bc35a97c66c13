/** The decoder by itself; the package declares only its front door. */
declare module "jpeg-js/lib/decoder.js" {
  import type { decode } from "jpeg-js";
  const decoder: typeof decode;
  export default decoder;
}

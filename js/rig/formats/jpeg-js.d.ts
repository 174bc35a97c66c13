/** The decoder alone; the package declares types only for its main module. */
declare module "jpeg-js/lib/decoder.js" {
  import type { decode } from "jpeg-js";
  const decoder: typeof decode;
  export default decoder;
}

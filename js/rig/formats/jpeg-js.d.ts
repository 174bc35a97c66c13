/** Declares the decoder, because the package has types only for its main module. */
declare module "jpeg-js/lib/decoder.js" {
  import type { decode } from "jpeg-js";
  const decoder: typeof decode;
  export default decoder;
}

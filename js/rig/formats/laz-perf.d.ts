/** The decoder for browsers, and its code as scripts/build.mjs packs it; the package declares types only for its main module. */
declare module "laz-perf/lib/web/laz-perf.js" {
  interface Options {
    instantiateWasm: (
      imports: WebAssembly.Imports,
      receive: (instance: WebAssembly.Instance) => void,
    ) => Record<string, never>;
    print: () => void;
    printErr: () => void;
  }
  interface LasZip {
    open(file: number, length: number): void;
    getPoint(into: number): void;
    getCount(): number;
    getPointLength(): number;
  }
  export interface LazPerf {
    readonly HEAPU8: Uint8Array<ArrayBuffer>;
    readonly LASZip: new () => LasZip;
    _malloc(length: number): number;
  }
  const create: (options: Options) => Promise<LazPerf>;
  export default create;
}

declare module "laz-perf/lib/web/laz-perf.wasm" {
  /** The code, compressed by zlib and written as base64. */
  const packed: string;
  export default packed;
}

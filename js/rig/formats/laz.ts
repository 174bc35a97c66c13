/**
 * The points of LAZ, which is LAS compressed by arithmetic coding: laz-perf, loaded with the first such file.
 *
 * laz-perf (0.0.7, 100 kB gzipped) reads bytes in memory and creates no code at run time, which a content security policy would forbid.
 * copc and @loaders.gl/las contain laz-perf too, together with code for pyramids of tiles and tables. Its code is embedded in the script,
 * so that no bundler loses it. Limits: it does not read wave packets (point formats 4, 5, 9 and 10), and LAZ has no checksums.
 */
import create, { type LazPerf } from "laz-perf/lib/web/laz-perf.js";
import packed from "laz-perf/lib/web/laz-perf.wasm";
import { badFile } from "../../errors.js";
import { inflateUpTo } from "../../inflate.js";

/** Largest size of the decoder's code, bytes. */
const MOST_CODE = 2 ** 20;

let code: Promise<WebAssembly.Module> | undefined;
const compiled = () =>
  WebAssembly.compile(
    inflateUpTo(
      Uint8Array.from(atob(packed), (letter) => letter.charCodeAt(0)),
      MOST_CODE,
      "laz-perf",
    ).slice(),
  );

/** An instance for one file, since a damaged file leaves an instance in an unknown state. */
async function instance(): Promise<LazPerf> {
  code ??= compiled();
  const module = await code;
  return create({
    instantiateWasm: (imports, receive) => {
      void WebAssembly.instantiate(module, imports).then(receive);
      return {};
    },
    print: () => {},
    printErr: () => {},
  });
}

/** Calls `take` with each record of the file and its offset in a view, which is valid until the next call. */
export async function eachRecord(
  bytes: Uint8Array,
  { count, size }: { count: number; size: number },
  take: (view: DataView, at: number, point: number) => void,
): Promise<void> {
  const library = await instance();
  try {
    const file = library._malloc(bytes.length);
    library.HEAPU8.set(bytes, file);
    const reader = new library.LASZip();
    reader.open(file, bytes.length);
    if (reader.getCount() !== count || reader.getPointLength() !== size) throw new Error("its headers disagree");
    const record = library._malloc(size);
    let view = new DataView(library.HEAPU8.buffer);
    for (let point = 0; point < count; point++) {
      reader.getPoint(record);
      // The decoder's memory may have grown, which invalidates the old view.
      if (view.buffer !== library.HEAPU8.buffer) view = new DataView(library.HEAPU8.buffer);
      take(view, record, point);
    }
  } catch (error) {
    throw badFile(
      "this LAZ is damaged or cut off, or compressed in an unsupported way; unpack it (pdal translate in.laz out.las, or CloudCompare)",
      error,
    );
  }
}

/** Files that are not read: their formats, by first bytes or names, and a remedy for each. */
import { type BimodalError, badFile } from "../../errors.js";
import { SIZES } from "./grid.js";

export { pointList } from "./point-list.js";

/** `isPicture`: a browser may be able to read it. */
type Row = [pattern: RegExp, advice: string, isPicture?: true];

const EXPORT = "export its frames as colour images, 16-bit depth images and a file of the cameras";
const RECORDING =
  "drop it on the page's check of a rig, or read it with openRecording of bimodal-stereo/rig-recordings";
const CLOUD =
  "points of a LiDAR or scanner without rows and columns (unorganised); save them as PCD, PLY or LAS in the frame of one scan's sensor (CloudCompare, PDAL)";

/** Formats by their first bytes. */
const FIRST: Row[] = [
  [/^GIF8/, "a GIF; save it as PNG", true],
  [/^BM/, "a BMP; save it as PNG", true],
  [/^PK\x03\x04/, "a ZIP archive (.usdz and .r3d are, too); unpack it first"],
  [/^\x1f\x8b/, "compressed by gzip; unpack it first"],
  [/^BZh/, "compressed by bzip2; unpack it first"],
  [/^\xfd7zXZ/, "compressed by xz; unpack it first"],
  [/^\x28\xb5\x2f\xfd/, "compressed by Zstandard; unpack it first"],
  [/^7z\xbc\xaf/, "a 7z archive; unpack it first"],
  [/^Rar!/, "a RAR archive; unpack it first"],
  [
    /^bvx[12n$-]/,
    "compressed by LZFSE, as Record3D's depth maps and confidences are; unpack it with liblzfse and save it as .npy or .exr",
  ],
  [/^\x89HDF/, "HDF5; save the array as .npy"],
  [/^CDF[\x01\x02\x05]/, "netCDF; save the array as .npy"],
  [/^MATLAB/, "a .mat file of MATLAB; save the array as .npy or 16-bit PNG"],
  [/^.{4}ftyp(?:heic|heix|hevc|mif1|msf1|avif)/s, "HEIC or AVIF; save it as PNG or JPEG", true],
  [/^(?:.{4}ftyp|RIFF.{4}AVI )/s, "a video; save its frames as PNG"],
  [/^#ROSBAG|^\x89MCAP/, `a recording of ROS (.bag, .mcap); ${RECORDING}`],
  [
    /^SQLite format/,
    "a recording of ROS 2 in SQLite (.db3); `ros2 bag convert` writes it as MCAP (storage_id: mcap), which is read as a recording",
  ],
  [/^\x1a\x45\xdf\xa3/, `a Matroska recording (.mkv, such as the Azure Kinect's); ${RECORDING}`],
  [/^NI10/, `a recording of OpenNI (.oni); ${EXPORT}`],
  [/^SVO/, `a recording of the ZED (.svo); ${EXPORT} by the ZED SDK`],
  [/^ASTM-E57/, `E57: ${CLOUD}`],
  [/^glTF/, "a mesh (glTF); render a depth map from it"],
  [/^PXR-USDC|^#usda/, "a scene in USD; render a depth map from it"],
  [/^Kaydara FBX/, "a mesh (FBX); render a depth map from it"],
  [/^%PDF/, "a PDF"],
  [/^#\?(?:RADIANCE|RGBE)/, "Radiance's HDR; save it as EXR"],
  [/^8BPS/, "a PSD; save it as PNG"],
  [/^\xff\x0a|^\0{3}\x0cJXL/, "JPEG XL; save it as PNG", true],
  [/^YUV4MPEG2/, "a video; save its frames as PNG"],
  [/^BLENDER/, "a scene of Blender; render its depth as EXR"],
  [/^ARROW1/, "a table in Arrow; export its images first"],
  [/^RRF2/, `a recording of Rerun (.rrd); ${EXPORT}`],
  [/^\x80[\x02-\x05]/, "a pickle of Python, which may run code; save the array with numpy.save"],
  [/^\xff\x4f\xff\x51|^.{4}jP {2}/s, "JPEG 2000; save it as PNG", true],
  [/^PIEH/, "Sintel's .dpt or .flo; save the depth as .npy"],
  [/^livox_tech/, "a recording of Livox (.lvx); save a scan of it as PCD or LAS with Livox Viewer"],
  [
    /^.{4}OSF!/s,
    "a recording of Ouster (.osf); `ouster-cli source in.osf save out.bag` makes a bag of it, which is read as a recording",
  ],
  [/^PAR1/, "a table in Parquet; export its images first"],
  [
    /^\x0a\x0d\x0d\x0a|^\xd4\xc3\xb2\xa1|^\xa1\xb2\xc3\xd4/,
    "packets of a LiDAR (.pcap); save a scan of it as PCD with the manufacturer's viewer or driver",
  ],
];

/** Formats without known first bytes, by the ending of the name. */
const NAMED: Row[] = [
  [/\.klg$/i, `a log of Kintinuous and ElasticFusion (.klg); ${EXPORT}`],
  [/\.oni$/i, `a recording of OpenNI (.oni); ${EXPORT}`],
  [/\.svo2?$/i, `a recording of the ZED (.svo); ${EXPORT} by the ZED SDK`],
  [/\.sens$/i, `a recording of ScanNet (.sens); ${EXPORT} by its SensReader`],
  [/\.e57$/i, `E57: ${CLOUD}`],
  [/\.(?:fls|fws|zfs|rcp|rcs|ptg|lsproj)$/i, `a scan in its manufacturer's format: ${CLOUD}`],
  [/\.(?:xef|rssdk|xed)$/i, `a recording of a Kinect or RealSense in its manufacturer's format; ${EXPORT}`],
  [/\.r3d$/i, `a recording of Record3D (.r3d), which is a ZIP archive; ${EXPORT}`],
  [/\.stl$/i, "a mesh (STL); render a depth map from it"],
  [/\.(?:pt|pth|ckpt)$/i, "a file of PyTorch; save the array with numpy.save"],
  [/\.(?:tfrecords?|tfrec)(?:-|$)/i, "records of TensorFlow; export their images first"],
  [/\.(?:dng|cr[23w]|nef|arw|orf|rw2|raf|pef)$/i, "a raw photograph of a camera; develop it into a 16-bit TIFF or PNG"],
  [/\.(?:tar|lz4)$/i, "an archive; unpack it first"],
  [/\.(?:dae|3ds|abc|blend|x3d)$/i, "a mesh or scene; render a depth map from it"],
  [/\.lzf$/i, "compressed by LZF; unpack it first"],
];

/** Texts that are not calibrations, by their beginning. */
const TEXTS: Row[] = [
  [
    /^#\s*Rig calib list|^(?:#[^\n]*\n)*#\s*RIG_ID/,
    "the rigs of COLMAP (rigs.txt), whose sensors are numbered, not named; write the pose of the second camera as a 4x4 matrix, and take the cameras from cameras.txt",
  ],
  [
    /^\s*(?:(?:Pinhole|RadTan|EquiDistant|KannalaBrandt|FOV|ATAN)\s+)?(?:[-\d.eE+]+\s+){4,8}[-\d.eE+]+\s*\n\s*\d+\s+\d+\s*\n\s*(?:crop|full|none|[-\d.eE+\s]{9,})\s*\n\s*\d+\s+\d+\s*$/i,
    "a camera of DSO (camera.txt), whose numbers may be shares of the picture's size; write it as JSON with fx, fy, cx, cy in pixels, width, height, and distortion_model (equidistant or plumb_bob)",
  ],
  [
    /^(?:\s*#[^\n]*\n)*\s*(?:mtllib|usemtl|o\s|g\s|s\s|v\s|vn\s|vt\s)[^\n]*\n[\s\S]{0,4000}?^(?:v|vn|f)\s+[-\d.]/m,
    "a mesh in Wavefront's OBJ; render a depth map from it, or save an organised cloud",
  ],
  [/^solid\b[^\n]*\n\s*(?:facet|endsolid)/, "a mesh (STL); render a depth map from it"],
  [/^(?:ST|C|N|4|n)*OFF\s+\d+\s+\d+\s+\d+/, "a mesh (OFF); render a depth map from it"],
  [/^#usda/, "a scene in USD; render a depth map from it"],
  [/^\s*\{[\s\S]{0,4000}"asset"\s*:\s*\{[^{}]{0,400}"version"/, "a mesh (glTF); render a depth map from it"],
  [/^# ?vtk DataFile/, "data of VTK; save it as an organised PLY or PCD"],
  [/^#\s?(?:VRML|X3D)/, "a mesh (VRML); render a depth map from it"],
];

const refused = ([, advice, isPicture]: Row): BimodalError =>
  badFile(`it is ${advice}`, undefined, isPicture && { problem: "picture" });

/** The error about a file in a known format that is not supported; undefined for other files. */
export function knownContainer(name: string, bytes: Uint8Array): BimodalError | undefined {
  const head = String.fromCharCode(...bytes.subarray(0, 16));
  const row = FIRST.find(([pattern]) => pattern.test(head)) ?? NAMED.find(([pattern]) => pattern.test(name));
  return row && refused(row);
}

/** The error about a text in a known format that is not supported. */
export function knownText(text: string): BimodalError | undefined {
  const head = text.slice(0, 8192);
  const row = TEXTS.find(([pattern]) => pattern.test(head));
  return row && refused(row);
}

/** The error about such points if they are not a scan. */
export const pointsRefused = () =>
  badFile(
    "it looks like a LiDAR's points without rows and columns (unorganised, such as a velodyne .bin of KITTI or nuScenes). They are too few or too scattered for a range image; save them as an organised cloud or as a depth map",
  );

/** The error about a file of an unknown format, with the sizes that would fit if it holds raw pixels. */
export function rawRefused(bytes: Uint8Array) {
  const fitting = ([2, 4] as const).flatMap((each) =>
    SIZES.filter(([width, height]) => width * height * each === bytes.length).map(
      ([width, height]) => `${width}x${height} of ${8 * each} bits`,
    ),
  );
  return badFile(
    `its format is not supported; if it is raw data without a header, give its size in pixels (width and height)${fitting.length > 0 ? `: ${fitting.join(" or ")} would have its ${bytes.length} bytes` : ""}, or save it as 16-bit PNG or .npy`,
  );
}

/**
 * Files of products whose documentation, not the file, gives the units, quaternion order, frames or modes. Each product has a reader; these
 * run before the search by names of members (tree.ts).
 */
import { isA2d2, readA2d2 } from "./a2d2.js";
import { isAria, readAria } from "./aria.js";
import {
  isArgoverse,
  isArgoverse2,
  isArgoverse2Table,
  readArgoverse,
  readArgoverse2,
  readArgoverse2Table,
} from "./argoverse.js";
import { isAutoware, readAutoware } from "./autoware.js";
import { isAzureKinect, isAzurePrint, readAzureKinect, readAzurePrint } from "./azure-kinect.js";
import { isBasalt, readBasalt } from "./basalt.js";
import { isBop, readBop } from "./bop.js";
import { isDepthai, readDepthai } from "./depthai.js";
import { isHandEye, readHandEye } from "./easy-handeye.js";
import type { Findings } from "./findings.js";
import { isKalibrResults, readKalibrResults } from "./kalibr-results.js";
import { isKinect2, readKinect2 } from "./kinect-v2.js";
import { isKitti, readKitti } from "./kitti.js";
import { isBouguet, isMatlab, readBouguet, readMatlab } from "./matlab.js";
import { isMiddlebury, readMiddlebury } from "./middlebury.js";
import { isMrcal, looksLikeMrcal, readMrcal } from "./mrcal.js";
import { isMultical, readMultical } from "./multical.js";
import { isNerf, readNerf } from "./nerf.js";
import { isNode, type Node } from "./numbers.js";
import { isNuscenes, readNuscenes } from "./nuscenes.js";
import { isInfoTable, isSimd, isStamped, readInfoTable, readSimd, readStamped } from "./prints.js";
import { isEnumeration, isPrinted, isSnapshot, readEnumeration, readPrinted, readSnapshot } from "./realsense.js";
import { isRecord3d, readRecord3d } from "./record3d.js";
import { isScannet, readScannet } from "./scannet.js";
import { isUrdf, readUrdf } from "./urdf.js";
import { isVlcal, readVlcal } from "./vlcal.js";
import { isWaymo, isWaymoText, readWaymo, readWaymoText } from "./waymo.js";
import { isCommandWindow, isOrbbecPrint, readCommandWindow, readOrbbecPrint } from "./windows.js";
import type { Element } from "./xml.js";
import { isZed, readZed } from "./zed.js";
import { isZivid, readZivid } from "./zivid.js";

type Product<Of> = [format: string, is: (whole: Of) => boolean, read: (whole: Of) => Findings];

const TEXTS: Product<string>[] = [
  ["RealSense's list of streams", isEnumeration, readEnumeration],
  ["a print of pyrealsense2", isPrinted, readPrinted],
  ["a snapshot of RealSense's viewer", isSnapshot, readSnapshot],
  ["a print of Orbbec's SDK", isOrbbecPrint, readOrbbecPrint],
  ["a print of MATLAB's command window", isCommandWindow, readCommandWindow],
  ["a print of simd", isSimd, readSimd],
  ["a print of ROS's transform", isStamped, readStamped],
  ["a table of ROS's camera_info", isInfoTable, readInfoTable],
  ["an Azure Kinect's printed calibration", isAzurePrint, readAzurePrint],
  ["a ZED's calibration", isZed, readZed],
  ["ScanNet's description of a scene", isScannet, readScannet],
  ["a result of Bouguet's toolbox", isBouguet, readBouguet],
  ["a calibration of Waymo's dataset", isWaymoText, readWaymoText],
  ["a table of Argoverse 2", isArgoverse2Table, readArgoverse2Table],
  ["Kalibr's results", isKalibrResults, readKalibrResults],
  ["a calibration of KITTI", isKitti, readKitti],
  ["Middlebury's calibration of a stereo pair", isMiddlebury, readMiddlebury],
];

const TREES: Product<Node>[] = [
  ["a calibration of direct_visual_lidar_calibration", isVlcal, readVlcal],
  ["a calibration of depthai", isDepthai, readDepthai],
  ["an Azure Kinect's calibration", isAzureKinect, readAzureKinect],
  ["a Kinect v2's intrinsics", isKinect2, readKinect2],
  ["a calibration of A2D2", isA2d2, readA2d2],
  ["a calibration of Argoverse", isArgoverse, readArgoverse],
  ["a calibration of Waymo's dataset", isWaymo, readWaymo],
  ["a calibration of Project Aria", isAria, readAria],
  ["a calibration of Basalt", isBasalt, readBasalt],
  ["mrcal's cameramodel", isMrcal, readMrcal],
  ["MATLAB's parameters", isMatlab, readMatlab],
  ["a file of Zivid", isZivid, readZivid],
  ["a result of easy_handeye", isHandEye, readHandEye],
  ["a transforms.json of nerfstudio", isNerf, readNerf],
  ["the metadata of Record3D", isRecord3d, readRecord3d],
  ["a calibration of multical", isMultical, readMultical],
  ["a camera with a depth_scale, as of BOP", isBop, readBop],
  ["a sensor kit's calibration of Autoware", isAutoware, readAutoware],
];

type Found = Findings & { format: string };

/** The findings of a reader, with the name of the format; they must not be empty. */
const named = (found: Findings, format: string): Found => Object.assign(found.done(format), { format });

/** The cameras and poses of a product's text; undefined where no product is recognised. */
export function productOfText(text: string): Found | undefined {
  const [format, , read] = TEXTS.find(([, is]) => is(text)) ?? [];
  return format !== undefined && read ? named(read(text), format) : undefined;
}

/** Largest number of members of one object; a scene of BOP has some thousand images. */
const MOST_MEMBERS = 20_000;

/** The cameras and poses of a product's object, which may be the only document of a YAML file. */
export function productOfTree(value: unknown): Found | undefined {
  const whole: unknown = Array.isArray(value) && value.length === 1 ? value[0] : value;
  // Each reader looks through all members to recognise its product.
  if (isNode(whole) && Object.keys(whole).length > MOST_MEMBERS) return undefined;
  const [format, , read] = (isNode(whole) ? TREES.find(([, is]) => is(whole)) : undefined) ?? [];
  if (format !== undefined && read && isNode(whole)) return named(read(whole), format);
  if (Array.isArray(value) && isArgoverse2(value)) return named(readArgoverse2(value), "a table of Argoverse 2");
  return isNuscenes(value) ? named(readNuscenes(value), "a table of nuScenes") : undefined;
}

/** The poses of a product's XML document. */
export const productOfXml = (root: Element): Found | undefined =>
  isUrdf(root) ? named(readUrdf(root), "a robot description (URDF)") : undefined;

/** Whether a text is a dictionary of Python that YAML reads as well. */
export const isPythonTree = looksLikeMrcal;

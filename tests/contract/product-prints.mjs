// Small files of the kinds that the catalogue of prints names (js/rig/formats/catalogue/prints.ts).
import { text } from "./rig-support.mjs";

const words = (name, content) => ({ name, bytes: text(content) });

export const PRINT_SAMPLES = {
  "matrix-lens": words("calib.txt", "611.4 0 324.8\n0 610.9 236.4\n0 0 1\n\n0.11 -0.27 0.0008 -0.0004 0.09\n"),
  "orbbec-print": words(
    "param.txt",
    "<OBCameraParam\n depth_intrinsic < fx=421.4 fy =421.9 cx=318.6 cy =241.1 width=640 height=480 >\n rgb_intrinsic < fx=611.4 fy =610.9 cx=324.8 cy =236.4 width=640 height=480 >\n transform < rot=[1, 0, 0, 0, 1, 0, 0, 0, 1]\n trans=[14.8, -0.2, 0.4]\n>",
  ),
  "matlab-window": words(
    "K.txt",
    "K =\n\n   1.0e+03 *\n\n    0.6114         0    0.3258\n         0    0.6109    0.2374\n         0         0    0.0010\n",
  ),
  "simd-print": words("k.txt", "simd_float3x3([[1443.2, 0.0, 0.0], [0.0, 1443.2, 0.0], [958.7, 722.3, 1.0]])"),
  "tf-print": words(
    "lookup.txt",
    "geometry_msgs.msg.TransformStamped(header=std_msgs.msg.Header(frame_id='camera'), child_frame_id='lidar', transform=geometry_msgs.msg.Transform(translation=geometry_msgs.msg.Vector3(x=0.1, y=0.2, z=0.3), rotation=geometry_msgs.msg.Quaternion(x=0.0, y=0.0, z=0.6, w=0.8)))",
  ),
  "info-table": words(
    "camera_info.csv",
    "%time,field.height,field.width,field.distortion_model,field.D0,field.D1,field.D2,field.D3,field.D4,field.K0,field.K1,field.K2,field.K3,field.K4,field.K5,field.K6,field.K7,field.K8\n17,480,640,plumb_bob,0.1,-0.2,0.001,-0.002,0.05,611.4,0,324.8,0,610.9,236.4,0,0,1\n",
  ),
};

"""Files of a rig as other programs write them, for tests/contract/rig-files.test.mjs.

pip install numpy pillow opencv-python-headless tifffile imagecodecs OpenEXR open3d pyyaml
python3 -P scripts/reference/rig-files.py tests/fixtures/rig   (-P: the open3d.py beside it is not the package)

All files hold the same: 16x12 pixels, depths of 800 + 37 x + 11 y millimetres with holes where x + y is a multiple of 7, colours of
(16 x, 20 y, 8 (x + y)), and the cameras and the motion below. tests/contract/rig-files.test.mjs has the same formulas.
"""

import json
import struct
import sys
from pathlib import Path

import cv2
import numpy as np
import open3d as o3d
import OpenEXR
import tifffile
import yaml
from PIL import Image, ImageCms

OUT = Path(sys.argv[1])
OUT.mkdir(parents=True, exist_ok=True)
W, H = 16, 12
X, Y = np.meshgrid(np.arange(W), np.arange(H))
MM = np.where((X + Y) % 7 == 0, 0, 800 + 37 * X + 11 * Y).astype(np.uint16)
METRES = (MM / 1000).astype(np.float32)
RGB = np.stack([16 * X, 20 * Y, 8 * (X + Y)], -1).astype(np.uint8)
K = np.array([[518.5, 0, 325.5], [0, 519.25, 253.75], [0, 0, 1]])
DIST = np.array([0.2, -0.5, 0.001, -0.002, 0.3])
VECTOR = np.array([0.02, -0.03, 0.05])
R = cv2.Rodrigues(VECTOR)[0]
T = np.array([-0.025, 0.001, 0.003])
POSE = np.eye(4)
POSE[:3, :3], POSE[:3, 3] = R, T
CLOUD = np.where(METRES[..., None] > 0, np.stack([(X - 7.5) / 20 * METRES, (Y - 5.5) / 20 * METRES, METRES], -1), np.nan).astype(np.float32)


def pictures():
    cv2.imwrite(str(OUT / "depth-cv.png"), MM)
    cv2.imwrite(str(OUT / "depth-cv.pfm"), METRES)
    cv2.imwrite(str(OUT / "depth-cv.pgm"), MM)
    cv2.imwrite(str(OUT / "depth-cv.tiff"), METRES)
    cv2.imwrite(str(OUT / "colour-cv.ppm"), RGB[..., ::-1])
    cv2.imwrite(str(OUT / "colour-cv16.png"), (RGB[..., ::-1].astype(np.uint16) * 257))
    np.save(OUT / "depth-columns.npy", np.asfortranarray(METRES))
    np.save(OUT / "cloud-columns.npy", np.asfortranarray(CLOUD))
    image = Image.fromarray(RGB)
    image.save(OUT / "colour.webp", lossless=True)
    image.save(OUT / "colour.jpg", quality=95, subsampling=0)
    image.save(OUT / "colour-progressive.jpg", quality=95, progressive=True, subsampling=2)
    image.convert("L").save(OUT / "colour-grey.jpg", quality=95)
    image.convert("CMYK").save(OUT / "colour-cmyk.jpg")
    image.quantize(64).save(OUT / "colour-palette.png")
    # A picture that differs from all its rotations and mirror images; Pillow also applies the orientation of EXIF.
    for orientation in range(1, 9):
        exif = Image.Exif()
        exif[0x0112] = orientation
        if orientation == 6:
            image.save(OUT / "turned-6.tiff", exif=exif)
            image.save(OUT / "turned-6.jpg", exif=exif, quality=100, subsampling=0)
        image.save(OUT / f"turned-{orientation}.png", exif=exif)


def tiffs():
    def save(name, data, **options):
        tifffile.imwrite(OUT / f"depth-{name}.tif", data, **options)

    for compression in [None, "lzw", "zlib", "packbits"]:
        save(f"16-{compression}", MM, compression=compression)
        save(f"float-{compression}", METRES, compression=compression)
    save("16-predicted", MM, compression="lzw", predictor=2)
    save("float-predicted", METRES, compression="zlib", predictor=3)
    save("64-predicted", METRES.astype(np.float64), compression="lzw", predictor=3)
    save("big-endian", MM, byteorder=">", compression="zlib", predictor=2)
    save("big-endian-float", METRES, byteorder=">", compression="zlib", predictor=3)
    save("tiled", METRES, tile=(16, 16), compression="zlib", predictor=3)
    save("strips", MM, rowsperstrip=5, compression="lzw")
    save("zstd", METRES, compression="zstd")
    save("zstd-predicted", METRES, compression="zstd", predictor=3, rowsperstrip=5)
    save("bigtiff", METRES, bigtiff=True)
    save("bigtiff-lzw", MM, bigtiff=True, byteorder=">", compression="lzw", predictor=2, rowsperstrip=5)
    save("half", METRES.astype(np.float16), compression="zlib")
    save("lerc", METRES, compression="lerc")
    save("lerc-zstd", METRES, compression="lerc", compressionargs={"compression": "zstd"})
    save("lerc-deflate", METRES, compression="lerc", compressionargs={"compression": "deflate"})
    tifffile.imwrite(OUT / "colour-planes.tif", np.moveaxis(RGB, -1, 0), photometric="rgb", planarconfig="separate", compression="zlib")
    tifffile.imwrite(OUT / "colour.tif", RGB, photometric="rgb", compression="lzw", predictor=2)
    # A picture that fills the table of LZW codes, so that it is cleared.
    noise = np.random.default_rng(1).integers(0, 1 << 16, (80, 80), dtype=np.uint16)
    tifffile.imwrite(OUT / "noise.tif", noise, compression="lzw")
    (OUT / "noise.json").write_text(json.dumps({"sum": int(noise.astype(np.int64).sum()), "last": int(noise[-1, -1]), "middle": int(noise[40, 40])}))


def exrs():
    kinds = {"none": OpenEXR.NO_COMPRESSION, "rle": OpenEXR.RLE_COMPRESSION, "zips": OpenEXR.ZIPS_COMPRESSION, "zip": OpenEXR.ZIP_COMPRESSION, "piz": OpenEXR.PIZ_COMPRESSION}
    for name, compression in kinds.items():
        header = {"compression": compression, "type": OpenEXR.scanlineimage}
        OpenEXR.File(header, {"Z": METRES}).write(str(OUT / f"depth-{name}.exr"))
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    linear = (RGB / 255).astype(np.float16)
    OpenEXR.File(header, {"R": linear[..., 0].copy(), "G": linear[..., 1].copy(), "B": linear[..., 2].copy(), "Z": METRES}).write(str(OUT / "colour-and-depth.exr"))


def large_exrs():
    """64x48 pixels, so that some blocks are shorter: depths of 0.75 + x / 64 + y / 128 metres, exact in half precision, and colours of (x, y, (x + y) / 2) / 64."""
    x, y = np.meshgrid(np.arange(64), np.arange(48))
    depth = np.where((x + y) % 7 == 0, 0, 0.75 + x / 64 + y / 128)
    colours = {"R": x / 64, "G": y / 64, "B": (x + y) / 128}

    def write(name, compression, channels):
        header = {"compression": compression, "type": OpenEXR.scanlineimage}
        OpenEXR.File(header, channels).write(str(OUT / f"large-{name}.exr"))

    half, full = [{"Z": depth.astype(kind)} for kind in (np.float16, np.float32)]
    rgb = {name: values.astype(np.float16) for name, values in colours.items()}
    write("piz-half", OpenEXR.PIZ_COMPRESSION, half)
    write("piz-float", OpenEXR.PIZ_COMPRESSION, full)
    write("piz-colours", OpenEXR.PIZ_COMPRESSION, {**rgb, "Z": half["Z"]})
    write("pxr24-float", OpenEXR.PXR24_COMPRESSION, full)
    write("pxr24-mixed", OpenEXR.PXR24_COMPRESSION, {**rgb, **full})
    write("dwaa-colours", OpenEXR.DWAA_COMPRESSION, rgb)
    write("dwab-colours", OpenEXR.DWAB_COMPRESSION, rgb)
    write("dwaa-depth", OpenEXR.DWAA_COMPRESSION, full)
    write("b44", OpenEXR.B44_COMPRESSION, half)


def clouds():
    cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(CLOUD.reshape(-1, 3).astype(np.float64)))
    for name, options in {"ascii": {"write_ascii": True}, "binary": {}, "compressed": {"compressed": True}}.items():
        path = OUT / f"cloud-{name}.pcd"
        o3d.io.write_point_cloud(str(path), cloud, **options)
        # Open3D does not keep rows and columns; they are added here, in the point cloud library's form.
        text = path.read_bytes().replace(b"WIDTH %d" % (W * H), b"WIDTH %d" % W).replace(b"HEIGHT 1\n", b"HEIGHT %d\n" % H)
        path.write_bytes(text)
    for name, ascii in {"ascii": True, "binary": False}.items():
        path = OUT / f"cloud-{name}.ply"
        o3d.io.write_point_cloud(str(path), cloud, write_ascii=ascii)
        path.write_bytes(path.read_bytes().replace(b"element vertex", b"obj_info num_cols %d\nobj_info num_rows %d\nelement vertex" % (W, H), 1))


def calibrations():
    for name in ["opencv.yaml", "opencv.xml", "opencv.json"]:
        storage = cv2.FileStorage(str(OUT / name), cv2.FILE_STORAGE_WRITE)
        for key, value in {"image_width": 640, "image_height": 480, "camera_matrix": K, "distortion_coefficients": DIST.reshape(-1, 1)}.items():
            storage.write(key, value)
        storage.release()
    for name, rotation in {"stereo.yaml": R, "stereo-vector.xml": VECTOR.reshape(3, 1)}.items():
        storage = cv2.FileStorage(str(OUT / name), cv2.FILE_STORAGE_WRITE)
        values = {"M1": K, "D1": DIST.reshape(1, -1), "M2": K + np.diag([10, 10, 0]), "D2": np.zeros((1, 5)), "R": rotation, "T": 1000 * T.reshape(3, 1) if "stereo.yaml" == name else T.reshape(3, 1)}
        for key, value in values.items():
            storage.write(key, value)
        storage.release()
    flat = lambda matrix: {"rows": matrix.shape[0], "cols": matrix.shape[1], "data": matrix.ravel().tolist()}
    ros = {"image_width": 640, "image_height": 480, "camera_name": "rgb", "camera_matrix": flat(K), "distortion_model": "plumb_bob", "distortion_coefficients": flat(DIST.reshape(1, 5)), "rectification_matrix": flat(np.eye(3)), "projection_matrix": flat(np.hstack([K, np.zeros((3, 1))]))}
    (OUT / "camera_info.yaml").write_text(yaml.safe_dump(ros, sort_keys=False))
    cameras = {"camera_model": "pinhole", "distortion_model": "radtan", "distortion_coeffs": DIST[:4].tolist(), "intrinsics": [K[0, 0], K[1, 1], K[0, 2], K[1, 2]], "resolution": [640, 480], "rostopic": "/cam/image"}
    kalibr = {"cam0": {**cameras, "cam_overlaps": [1]}, "cam1": {**cameras, "distortion_model": "equidistant", "T_cn_cnm1": POSE.tolist()}}
    for camera in kalibr.values():
        for key in ["intrinsics", "resolution"]:
            camera[key] = [float(value) for value in camera[key]]
    (OUT / "camchain.yaml").write_text(yaml.dump(kalibr))
    intrinsic = o3d.camera.PinholeCameraIntrinsic(640, 480, K[0, 0], K[1, 1], K[0, 2], K[1, 2])
    o3d.io.write_pinhole_camera_intrinsic(str(OUT / "open3d-intrinsic.json"), intrinsic)
    parameters = o3d.camera.PinholeCameraParameters()
    parameters.intrinsic, parameters.extrinsic = intrinsic, POSE
    o3d.io.write_pinhole_camera_parameters(str(OUT / "open3d-parameters.json"), parameters)
    trajectory = o3d.camera.PinholeCameraTrajectory()
    trajectory.parameters = [parameters, parameters]
    o3d.io.write_pinhole_camera_trajectory(str(OUT / "open3d-trajectory.json"), trajectory)
    o3d.io.write_pinhole_camera_trajectory(str(OUT / "redwood.log"), trajectory)
    np.savetxt(OUT / "pose.txt", POSE)
    np.savetxt(OUT / "K.txt", K)


def profile(red, green, blue, gamma):
    """A colour profile of three primaries (XYZ under D50) and a curve."""
    fixed = lambda values: b"".join(struct.pack(">i", round(65536 * value)) for value in values)
    text = b"A test's own wide colours"
    tags = {b"desc": b"desc\0\0\0\0" + struct.pack(">I", len(text) + 1) + text + b"\0" + bytes(78), b"cprt": b"text\0\0\0\0none\0", b"wtpt": b"XYZ \0\0\0\0" + fixed([0.9642, 1, 0.8249])}
    for name, primary in {b"r": red, b"g": green, b"b": blue}.items():
        tags[name + b"XYZ"] = b"XYZ \0\0\0\0" + fixed(primary)
        tags[name + b"TRC"] = b"curv\0\0\0\0" + struct.pack(">IH", 1, round(256 * gamma))
    table, body = b"", b""
    start = 128 + 4 + 12 * len(tags)
    for name, data in tags.items():
        data += bytes(-len(data) % 4)
        table += name + struct.pack(">II", start + len(body), len(data))
        body += data
    size = start + len(body)
    head = struct.pack(">I4sI4s4s4s", size, b"lcms", 0x02400000, b"mntr", b"RGB ", b"XYZ ") + struct.pack(">6H", 2026, 1, 1, 0, 0, 0) + b"acsp"
    head = head + bytes(68 - len(head)) + fixed([0.9642, 1, 0.8249])
    return head + bytes(128 - len(head)) + struct.pack(">I", len(tags)) + table + body


def profiles():
    wide = profile([0.51512, 0.2412, -0.00105], [0.29198, 0.69225, 0.04189], [0.1571, 0.06657, 0.78407], 2.2)
    (OUT / "wide.icc").write_bytes(wide)
    image = Image.fromarray(RGB)
    image.save(OUT / "colour-wide.png", icc_profile=wide)
    image.save(OUT / "colour-wide.jpg", icc_profile=wide, quality=100, subsampling=0)
    image.save(OUT / "colour-srgb.png", icc_profile=ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes())
    import io

    converted = ImageCms.profileToProfile(image, ImageCms.ImageCmsProfile(io.BytesIO(wide)), ImageCms.createProfile("sRGB"), renderingIntent=1)
    converted.save(OUT / "colour-wide-by-lcms.png")


for make in [pictures, tiffs, exrs, large_exrs, clouds, calibrations, profiles]:
    make()

// The notations of calibrations: JSON with comments, TOML, Python, numbers with labels, decimal commas.
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { writeNpy } from "../../pkg/write.js";
import { codes, distortion, matrix, only, read, rows, sameCamera, samePose, translation } from "./rig-support.mjs";

describe("languages", () => {
  test("JSON with comments, and Python's print of a dictionary", async () => {
    sameCamera(
      only(
        (await read("k.json", '{\n  // colour\n  "fx": 518.5, "fy": 519.25, /* px */ "cx": 325.5, "cy": 253.75,\n}'))
          .cameras,
      ),
      null,
    );
    const printed =
      "{'fx': 518.5, 'fy': 519.25, 'cx': 325.5, 'cy': 253.75, 'dist': array([0.2, -0.5, 0.001, -0.002, 0.3], dtype=float32), 'ok': True, 'x': None}";
    sameCamera(only((await read("k.txt", printed)).cameras));
  });

  test("texts of an older Windows, whose umlauts are bytes that UTF-8 has not", async () => {
    const line = "# Kalibrierung für die Tür, 20 °C\nfx: 518.5\nfy: 519.25\ncx: 325.5\ncy: 253.75\n";
    sameCamera(only((await read("k.yaml", new Uint8Array(Buffer.from(line, "latin1")))).cameras), null);
  });

  test("TOML, and sections that are none", async () => {
    const toml = await read(
      "rig.toml",
      `[color]\nfx = 518.5\nfy = 519.25\ncx = 325.5\ncy = 253.75\nresolution = [640, 480]\ndistortion = [${distortion}]\n[depth_to_color]\nR = [[${rows[0]}], [${rows[1]}], [${rows[2]}]]\nt = [${translation}]\n`,
    );
    sameCamera(only(toml.cameras));
    assert.deepEqual([toml.cameras[0].name, toml.cameras[0].width], ["color", 640]);
    samePose(only(toml.poses));
    const ini =
      "; made by hand\n[left camera]\nmodel=some lens\nfx=518.5\nfy=519.25\ncx=325.5\ncy=253.75\nserial=00-1A\n";
    sameCamera(only((await read("k.ini", ini)).cameras), null);
  });

  test("numbers with labels: ost.txt, rows below a name, print() and arrays of Python", async () => {
    const lines = rows.map((row, at) => [...row, translation[at]].join(" "));
    const text = `K = np.array([[518.5, 0, 325.5],\n              [0, 519.25, 253.75],\n              [0, 0, 1]])\ndist = np.array([${distortion}])\n`;
    const script = await read(
      "calib.py",
      `import numpy as np\n${text}R = np.array([[${rows[0]}], [${rows[1]}], [${rows[2]}]])\nt = np.array([${translation}])\n`,
    );
    sameCamera(only(script.cameras));
    samePose(only(script.poses));
    const named = await read("T.txt", `T_color_depth:\n${lines.join("\n")}\n0 0 0 1\n`);
    samePose(only(named.poses));
    assert.deepEqual([named.poses[0].from, named.poses[0].to], ["depth", "color"]);
    samePose(
      only(
        (
          await read(
            "T.txt",
            `array([[${lines.map((line) => line.replace(/ /g, ", ")).join("],\n       [")}],\n       [0., 0., 0., 1.]])`,
          )
        ).poses,
      ),
    );
    sameCamera(only((await read("k.txt", "fx 518.5\nfy 519.25\ncx 325.5\ncy 253.75\n")).cameras), null);
    const print = `width: 640, height: 480, ppx: 325.5, ppy: 253.75, fx: 518.5, fy: 519.25, model: Brown Conrady, coeffs: [${distortion}]`;
    const printed = only((await read("k.txt", print)).cameras);
    sameCamera(printed);
    assert.equal(printed.width, 640);
    const ost = `# oST version 5.0 parameters\n\n\n[image]\n\nwidth\n640\n\nheight\n480\n\n[narrow_stereo]\n\ncamera matrix\n518.5 0.0 325.5\n0.0 519.25 253.75\n0.0 0.0 1.0\n\ndistortion\n${distortion.join(" ")}\n\nrectification\n1 0 0\n0 1 0\n0 0 1\n\nprojection\n500 0 320 0\n0 500 240 0\n0 0 1 0\n`;
    const found = await read("ost.txt", ost);
    sameCamera(only(found.cameras));
    assert.deepEqual([found.cameras[0].name, found.cameras[0].width, codes(found)], ["narrow_stereo", 640, []]);
  });

  test("decimal commas", async () => {
    const comma = (value) => value.toFixed(9).replace(".", ",");
    const table = matrix.map((row) => row.map(comma).join(";")).join("\n");
    const { poses, says } = await read("T.csv", table);
    samePose(only(poses));
    assert.match(says, /decimal commas/);
    samePose(only((await read("T.txt", table.replace(/;/g, " "))).poses));
    sameCamera(only((await read("k.txt", "fx = 518,5\nfy = 519,25\ncx = 325,5\ncy = 253,75\n")).cameras), null);
    // Commas that separate whole numbers remain separators.
    sameCamera(only((await read("K.csv", "500,0,320\n0,501,240\n0,0,1\n")).cameras), null, {
      fx: 500,
      fy: 501,
      cx: 320,
      cy: 240,
    });
  });

  test("a COLMAP camera of a model that is not known costs itself alone", async () => {
    const { cameras, warnings } = await read(
      "cameras.txt",
      "1 OPENCV 640 480 518.5 519.25 326 254.25 0.1 0.2 0 0\n2 THIN_PRISM_FISHEYE 640 480 500 500 320 240 0 0 0 0 0 0 0 0\n",
    );
    assert.equal(only(cameras).name, "1");
    assert.match(warnings[0].message, /THIN_PRISM_FISHEYE/);
  });

  test("matrices in .npy files", async () => {
    const npy = (values, width) =>
      writeNpy({ width, height: values.length / width, channels: 1, data: Float32Array.from(values) });
    sameCamera(only((await read("K.npy", npy([512.5, 0, 320.5, 0, 513, 240.25, 0, 0, 1], 3))).cameras), null, {
      ...{ fx: 512.5, fy: 513, cx: 320.5, cy: 240.25 },
    });
    samePose(only((await read("T.npy", npy(matrix.flat(), 4))).poses));
    assert.equal((await read("depth.npy", npy([1, 2, 3, 1, 2, 3, 1, 2, 3], 3), { as: "depth" })).kind, "depth");
  });

  test("COLMAP's cameras.bin and images.txt", async () => {
    const bytes = new Uint8Array(8 + 24 + 8 * 4);
    const view = new DataView(bytes.buffer);
    view.setUint32(0, 1, true);
    view.setUint32(8, 7, true);
    view.setInt32(12, 1, true);
    view.setBigUint64(16, 640n, true);
    view.setBigUint64(24, 480n, true);
    [518.5, 519.25, 326, 254.25].forEach((value, at) => view.setFloat64(32 + 8 * at, value, true));
    const { cameras } = await read("cameras.bin", bytes);
    sameCamera(only(cameras), null);
    assert.deepEqual([cameras[0].name, cameras[0].width], ["7", 640]);
    const images = await read(
      "images.txt",
      `# Image list\n1 0.999525037602976 0.009998416741873298 -0.014997625112809946 0.024996041854683248 ${translation.join(" ")} 1 a.png\n10 20 -1\n`,
    );
    const pose = only(images.poses);
    assert.deepEqual([pose.name, pose.from, pose.to, codes(images)], ["a.png", "camera", "world", ["camera-to-world"]]);
  });
});

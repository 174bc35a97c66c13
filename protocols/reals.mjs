// Camera images: Table 3 and Figure 7 on real pairs, and real photographs of scanned objects.
import { FROM_ANYWHERE, PAPER_TABLE_3 } from "./scenes.mjs";

/** Replacements for the paper's frames, which are not public; cereal_box stands for its food_box. */
const PAIRS = ["cereal_box_1", "coffee_mug_1", "bowl_1", "cap_1", "vase_rgbd"];
/**
 * Degrees between colour and depth in the two frames of a pair (registered for the vase): consecutive frames are so close that the
 * identity, without any estimate, would pass.
 */
const KNOWN_TURN = { coffee_mug_1: 0.15, bowl_1: 0.09, cap_1: 0.5, cereal_box_1: 2.26, vase_rgbd: 0 };
/** Additional rotations of the depth's viewpoint, degrees: the cloud is rotated about its centre. */
const TURNS = [0, 20];

const pairCell = (name, turned) => ({
  id: `pairs/${name}/${turned}`,
  kind: "pair",
  row: { name: turned === 0 ? name : `${name} turned ${turned}`, truthWithin: KNOWN_TURN[name] },
  pair: name,
  turned,
  options: FROM_ANYWHERE,
});

const pairCells = ({ complete }, quick, turns) =>
  complete ? (quick ? ["bowl_1"] : PAIRS).flatMap((name) => turns.map((turned) => pairCell(name, turned))) : [];

export const table3 = {
  name: "table3",
  title:
    "Table 3: real pairs in place of the paper's, nothing known; degrees from a ground truth that is known within the figure beside them",
  paper: PAPER_TABLE_3,
  cells: (kit, quick) => pairCells(kit, quick, TURNS),
  rows: (results) =>
    results.map(({ cell, result }) => {
      const { pose, iterations, residualBefore, residualAfter, degrees, identityDegrees, status, milliseconds } =
        result;
      return {
        ...cell.row,
        pose,
        iterations,
        residualBefore,
        residualAfter,
        degrees,
        identityDegrees,
        status,
        milliseconds,
      };
    }),
};

export const figure7 = {
  name: "figure7",
  title: "Figure 7: holes of the real depth maps, and by how many degrees the refinement turned their normals (mean)",
  // The runs of Table 3.
  cells: (kit, quick) => pairCells(kit, quick, [0]),
  rows: (results) =>
    results.map(({ cell, result: { holesBefore, holesAfter, normalChange, status } }) => ({
      name: cell.row.name,
      holesBefore,
      holesAfter,
      normalChange,
      status,
    })),
};

export const PHOTOGRAPH_SIZE = 96;
/**
 * `lab_diffuse` has albedo and cast shadows, `lab_shading` only cast shadows, `render` neither (natural light A): the
 * differences show the cost of each.
 */
export const IMAGES = ["lab_diffuse", "lab_shading", "render"];
export const PHOTOGRAPH_BETAS = [0, 20, 40, 60];

const photographCell = (object, image, beta) => ({
  id: `photographs/${object}/${image}/${beta}`,
  kind: "photograph",
  row: { object, image, beta },
  scene: { surface: object, light: "A", size: PHOTOGRAPH_SIZE, angles: { beta } },
  photograph: image === "render" ? null : image,
  options: FROM_ANYWHERE,
});

export const photographs = {
  name: "photographs",
  title: "Photographs: real images of scanned objects, 96x96, nothing known",
  cells: ({ painted }, quick) =>
    quick
      ? painted.slice(0, 1).map((object) => photographCell(object, "lab_diffuse", 20))
      : painted.flatMap((object) =>
          IMAGES.flatMap((image) => PHOTOGRAPH_BETAS.map((beta) => photographCell(object, image, beta))),
        ),
};

/** Albedo and shading with cast shadows; the same shading with a single albedo; varying albedo under an exact natural light. */
export const PAINTS = ["lab_diffuse", "lab_shading", "natural_diffuse"];

const albedoCell = (object, image, pose) => ({
  id: `albedo/${object}/${image}/${pose}`,
  kind: "albedo",
  row: { object, image, pose, beta: pose === "told" ? 0 : 20 },
  scene: { surface: object, light: "A", size: PHOTOGRAPH_SIZE, angles: { beta: pose === "told" ? 0 : 20 } },
  photograph: image,
  options: pose === "told" ? { ...FROM_ANYWHERE, start: "truth", registration: "fixed" } : FROM_ANYWHERE,
});

export const albedo = {
  name: "albedo",
  title:
    "Albedo: log albedo against the measured one, 96x96, each channel up to an offset; naive takes all of log S for albedo",
  cells: ({ painted }, quick) =>
    quick
      ? painted.slice(0, 2).map((object) => albedoCell(object, "lab_diffuse", "told"))
      : painted.flatMap((object) =>
          PAINTS.flatMap((image) =>
            (image === "lab_diffuse" ? ["told", "found"] : ["told"]).map((pose) => albedoCell(object, image, pose)),
          ),
        ),
};

// The gallery of rendered pairs: what each shows, what makes it hard, and how its run ended with the default options. No picture is a
// photograph. `degrees` and `millimetres` are from the true pose; tests/contract/gallery.test.mjs runs each pair again.

export const GALLERY = [
  {
    kind: "bust",
    name: "Bust by a window",
    shows: "One albedo, light of nearly one colour, views 25 degrees apart.",
    level: "easy",
    ends: { status: "converged", degrees: 1.1, millimetres: 17 },
  },
  {
    kind: "knot",
    name: "Knot under clouds",
    shows: "A tube that hides parts of itself, so that each camera sees surfaces that the other does not.",
    level: "easy",
    ends: { status: "converged", degrees: 0.4, millimetres: 5 },
  },
  {
    kind: "relief",
    name: "Relief by a lamp",
    shows: "A carved disc. Half of its light comes from a lamp that casts shadows, which the model leaves out.",
    level: "medium",
    ends: { status: "ambiguous", degrees: 1.4, millimetres: 23 },
  },
  {
    kind: "cut",
    name: "Half a vase",
    shows: "The depth camera sees one half of the vase. The pose is three degrees off and called uncertain.",
    level: "medium",
    ends: { status: "ambiguous", degrees: 3.4, millimetres: 62 },
  },
  {
    kind: "marble",
    name: "Marble bust",
    shows: "Veins of two colours, which look like shading to a method that assumes a single albedo.",
    level: "medium",
    ends: { status: "ambiguous", degrees: 1.4, millimetres: 23 },
  },
  {
    kind: "bowl",
    name: "Bowl",
    shows: "It looks the same after any rotation about its axis, so that the pose cannot be found.",
    level: "fails",
    ends: { status: "ambiguous", degrees: 18, millimetres: 272 },
  },
];

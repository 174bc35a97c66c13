// Formats the tables of two pinhole cameras as text.
import { isConfidentlyWrong } from "../../protocols/counts.mjs";
import { mean, median, worst } from "../../protocols/numbers.mjs";
import { FOUND, REGISTERED, VIEWS } from "../../protocols/statue.mjs";
import { columns, fixed, mark, unique } from "./columns.mjs";

export function rgbd(rows) {
  const figures = ({ degrees, inPlane, tilt, lateral, along }) =>
    [degrees, inPlane, tilt, lateral, along].map((value) => fixed(value, 2));
  const medians = (name, members) => {
    const of = (key) => median(members.map((row) => row[key]));
    return [
      name,
      "",
      ...figures({
        degrees: of("degrees"),
        inPlane: of("inPlane"),
        tilt: of("tilt"),
        lateral: of("lateral"),
        along: of("along"),
      }),
      "",
    ];
  };
  const starts = unique(rows.map(({ start }) => start));
  return columns([
    ["capture", "seen from", "degrees", "in-plane", "tilt", "lateral mm", "along mm", "status"],
    ...rows.map((row) => [
      `${row.name}, ${row.start}${row.tuned ? " *" : ""}`,
      row.turned,
      ...figures(row),
      row.status + mark(row),
    ]),
    ...starts.flatMap((start) => {
      const members = rows.filter((row) => row.start === start);
      return [
        medians(`median, ${start}`, members),
        medians(
          `.. not tuned on`,
          members.filter(({ tuned }) => !tuned),
        ),
      ];
    }),
  ]);
}

/** Medians of rows by degrees between the views, the number of rows that became worse, and where registration is worthwhile. */
function statueLines(name, rows) {
  const count = (is) => `${rows.filter(is).length} of ${rows.length}`;
  const isWorse = ({ told, degrees, lateral }) => told !== null && degrees > told.degrees && lateral > told.lateral;
  const isRegistered = ({ degrees, lateral }) => degrees < REGISTERED.degrees && lateral < REGISTERED.lateral;
  const bins = VIEWS.map(({ below }, k) =>
    rows.filter(({ view }) => view < below && view >= (VIEWS[k - 1]?.below ?? 0)),
  );
  const medians = (members) =>
    members.length === 0
      ? "-"
      : ["degrees", "lateral", "along"].map((key) => fixed(median(members.map((row) => row[key])), 1)).join(", ");
  return [
    ...[name, ...bins.map(medians), count(isRegistered), count(({ degrees }) => degrees < FOUND)],
    ...[count(isWorse), count(isConfidentlyWrong), fixed(mean(rows.map(({ milliseconds }) => milliseconds)) / 1000, 1)],
  ];
}

export function statue(rows) {
  const starts = unique(rows.map(({ start }) => start));
  return [
    ...columns([
      ["pair", "view", "start", "degrees", "lateral mm", "along mm", "status"],
      ...rows.map((row) => [
        `${row.name}${row.tuned ? " *" : ""}`,
        ...[fixed(row.view, 0), row.start, fixed(row.degrees, 2), fixed(row.lateral, 1), fixed(row.along, 1)],
        row.status,
      ]),
    ]),
    ...columns([
      [
        ...["median degrees, lateral mm, along mm", ...VIEWS.map((view) => `${view.name} degrees apart`)],
        ...[`within ${REGISTERED.degrees} degrees, ${REGISTERED.lateral} mm`, `within ${FOUND} degrees`],
        ...["worse than it began", "overconfident", "s each"],
      ],
      ...starts.flatMap((start) =>
        [true, false].map((tuned) =>
          statueLines(
            `${start}, ${tuned ? "tuned on" : "not tuned on"}`,
            rows.filter((row) => row.start === start && row.tuned === tuned),
          ),
        ),
      ),
    ]),
  ];
}

export function pinhole(rows) {
  const starts = unique(rows.map(({ start }) => start));
  return columns([
    ["start", "scenes", "found", "median degrees", "mm", "worst degrees", "s each"],
    ...starts.map((start) => {
      const members = rows.filter((row) => row.start === start);
      const of = (key) => members.map((row) => row[key]);
      const found = members.filter(({ degrees }) => degrees < 3).length;
      return [
        ...[
          start === "search" ? "nothing known" : `${start} degrees off`,
          members.length,
          found,
          fixed(median(of("degrees"))),
        ],
        ...[
          fixed(median(of("translation")), 2),
          fixed(worst(of("degrees")), 2),
          fixed(median(of("milliseconds")) / 1000, 1),
        ],
      ];
    }),
  ]);
}

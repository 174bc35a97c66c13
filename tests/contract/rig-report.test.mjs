// The report of a check: a file that requests nothing, runs nothing, and contains every number.
import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { describe, test } from "node:test";
import { reportHtml } from "../../pkg/rig-write.js";
import { harmless } from "./harmless.mjs";
import { report } from "./rig-sample.mjs";
import { refused } from "./support.mjs";

const PIXEL =
  "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNkYPhfDwAChwGA60e6kgAAAABJRU5ErkJggg==";
const EVIL = `</style></title><script>alert(1)</script><img src=x onerror=alert(2)>"'&amp;`;

describe("the page", () => {
  test("is whole, and its policy allows its style sheet and pictures alone", () => {
    const page = reportHtml(report(), [{ title: "Overlay", dataUrl: PIXEL }]);
    const { elements } = harmless(page);
    const policy = elements
      .find(({ attributes }) => attributes["http-equiv"] === "Content-Security-Policy")
      .attributes.content.replaceAll("&#39;", "'");
    const style = /<style>([^<]*)<\/style>/.exec(page)[1];
    const hash = createHash("sha256").update(style).digest("base64");
    assert.equal(
      policy,
      `default-src 'none'; img-src data:; style-src 'sha256-${hash}'; base-uri 'none'; form-action 'none'`,
      "STYLE_SHA256 in style.ts",
    );
    assert.ok(page.indexOf("Content-Security-Policy") < page.indexOf("<style>"));
    assert.deepEqual(
      elements.filter(({ name }) => name === "img").map(({ attributes }) => attributes),
      [{ src: PIXEL, alt: "Overlay" }],
    );
    for (const query of ["prefers-color-scheme:dark", "@media print"]) assert.ok(style.includes(query), query);
  });

  test("says the same of the same report, and no date that it was not told", () => {
    assert.equal(reportHtml(report()), reportHtml(report()));
    assert.match(reportHtml(report(), [], { made: new Date(Date.UTC(2024, 1, 29, 13, 5)) }), /2024-02-29 13:05 UTC/);
  });

  test("holds the verdict, the numbers with units, warnings, frames and files", () => {
    const sha256 = "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08";
    const { text: spaced } = harmless(
      reportHtml(report(), [], {
        title: "Rig 7",
        inputs: [{ name: "depth/0001.png", says: "640x480, 16-bit", bytes: 480000, notes: ["many-holes"], sha256 }],
      }),
    );
    const text = spaced.replaceAll("\u202f", " ").replaceAll("&#39;", "'");
    const expected = [
      ...[
        "Rig 7",
        "Off, see warnings: expected reprojection error 17.4 px (95 %: 15.8 to 19.1 px)",
        "factory.yaml",
        "a true calibration lies as far",
        "1.92°, 21.3 mm",
        "17.4 px",
        "15.8 to 19.1 px",
        "0.840 px",
        "0.520 to 1.31 px",
      ],
      ...["last week", "Consistent", "0.110°", "0.610", "by hand", "Undecided", "below 0.001"],
      ...report().warnings.map((warning) => warning.message ?? warning),
      ...["55 %", "± 0.435 px", "no information", "0003.png", "13 %", "a bare wall"],
      ...["25.0 mm to the left of, 3.4 mm in front of and 0.2 mm below the colour camera, rotated by 1.37°", "93 %"],
      ...["0.999747456", "4.00e\u22126", "depth/0001.png", "480000 bytes", "many-holes", sha256],
    ];
    for (const words of expected) assert.ok(text.includes(words), words);
  });
});

describe("what comes from files is escaped", () => {
  test("in every string of a report", () => {
    const given = report();
    const [candidate] = Object.values(given.candidates);
    const evil = {
      ...given,
      reason: EVIL,
      warnings: [{ code: "many-holes", message: EVIL }],
      candidates: { [EVIL]: { ...candidate, reason: EVIL } },
      cues: { [EVIL]: { share: 1, sharpness: 1 } },
      frames: [{ name: EVIL, share: 1, note: EVIL }],
      sensitivity: given.sensitivity.map((row) => ({ ...row, cue: EVIL })),
    };
    const page = reportHtml(evil, [{ title: EVIL, dataUrl: PIXEL }], {
      title: EVIL,
      inputs: [{ name: EVIL, says: EVIL, sha256: EVIL }],
    });
    const { text } = harmless(page);
    assert.ok(!page.includes("<script"));
    assert.ok(text.split("&lt;script&gt;alert(1)").length > 10, "it is shown as it is");
    assert.ok(text.includes("&quot;&#39;&amp;amp;"));
  });

  test("words of the contract that are none of them", () => {
    const given = report();
    for (const word of [EVIL, "constructor", "toString"]) {
      const candidates = { a: { ...Object.values(given.candidates)[0], verdict: word } };
      harmless(reportHtml({ ...given, verdict: word, candidates, cues: { [word]: { share: 1, sharpness: 1 } } }));
    }
  });

  test("pictures that are none", () => {
    for (const dataUrl of [
      "https://example.org/x.png",
      "javascript:alert(1)",
      "data:image/svg+xml;base64,PHN2Zz4=",
      `${PIXEL}" onload="alert(1)`,
      "data:text/html;base64,AAAA",
      "",
    ]) {
      refused(() => reportHtml(report(), [{ title: "", dataUrl }]), "type", "pictures[0].dataUrl");
    }
  });
});

describe("curves", () => {
  const offsets = Array.from({ length: 101 }, (_, k) => (k - 50) / 10);
  const parabola = (best, sigma) => offsets.map((offset) => 100 - 0.5 * ((offset - best) / sigma) ** 2);
  const words = (values, axis = "ry", at = offsets) => {
    const { text } = harmless(reportHtml({ ...report(), sensitivity: [{ cue: "edges", axis, offsets: at, values }] }));
    return /Edges: ([^<]+?)(?=\n|Covariance)/.exec(text)?.[1].replaceAll("\u202f", " ");
  };

  test("a parabola's minimum and 1.96 sigmas either side", () => {
    assert.equal(words(parabola(0.5, 1)), "0.50° (\u22121.5 to 2.5)");
    assert.equal(words(parabola(-2, 0.25)), "\u22122.0° (\u22122.5 to \u22121.5)");
  });

  test("an interval that ends beyond the range is said to", () => {
    assert.equal(words(parabola(4, 1)), "4.0° (2.0 to above 5)");
    assert.equal(words(parabola(-4, 1), "tx"), "\u22124.0 mm (below \u22125 to \u22122.0)");
    assert.equal(words(parabola(1, 100)), "not constrained from \u22125 to 5°");
    assert.equal(words(offsets.map(() => 7)), "not constrained from \u22125 to 5°");
  });

  test("a minimum at the end of the range is said to lie there or beyond", () => {
    const end = "the minimum is at the end of the range or beyond, ";
    assert.equal(words(parabola(7, 2)), `${end}5.0° (2.6 to above 5)`);
    assert.ok(words(parabola(-7, 2), "tx").startsWith(`${end}\u22125.0 mm (below`));
    assert.ok(!words(parabola(4.9, 1)).includes("end of the range"));
  });

  test("the order of offsets does not matter, nor what is missing between", () => {
    const values = parabola(0.5, 1);
    const order = offsets.map((_, k) => (k * 37) % 101);
    assert.equal(
      words(
        order.map((k) => values[k]),
        "ry",
        order.map((k) => offsets[k]),
      ),
      "0.50° (\u22121.5 to 2.5)",
    );
    assert.equal(words(values.map((value, k) => (k % 10 === 3 ? NaN : value))), "0.50° (\u22121.5 to 2.5)");
  });

  test("no panel without two numbers", () => {
    assert.equal(words([NaN, 1, -Infinity]), undefined);
    assert.equal(words([]), undefined);
  });

  test("six panels, a line for each cue in each", () => {
    const { elements } = harmless(reportHtml(report()));
    const of = (kind) => elements.filter(({ attributes }) => attributes.class === kind).length;
    assert.equal(of("panel"), 6);
    assert.equal(of("series s1"), 12, "a line and its key");
    for (const { name, attributes } of elements)
      if (name === "path") assert.ok(attributes.d && !/NaN|Infinity|undefined/.test(attributes.d), attributes.d);
  });
});

describe("what a report lacks is named", () => {
  test("in the report", () => {
    for (const none of [undefined, null]) refused(() => reportHtml(none), "type", "report");
    for (const name of [
      "warnings",
      "estimate",
      "covariance",
      "health",
      "candidates",
      "cues",
      "frames",
      "sensitivity",
    ]) {
      for (const value of [undefined, null, 5])
        refused(() => reportHtml({ ...report(), [name]: value }), "type", `report.${name}`);
    }
    refused(() => reportHtml({ ...report(), candidates: { a: {} } }), "type", "report.candidates.a.interval");
    refused(() => reportHtml({ ...report(), cues: { edges: null } }), "type", "report.cues.edges");
    refused(() => reportHtml({ ...report(), frames: [{ name: "a", share: 1 }, null] }), "type", "report.frames[1]");
    refused(
      () => reportHtml({ ...report(), estimate: { rotation: [], translation: [] } }),
      "type",
      "report.estimate.angles",
    );
  });

  test("beside it", () => {
    refused(() => reportHtml(report(), null), "type", "pictures");
    refused(() => reportHtml(report(), [null]), "type", "pictures[0]");
    refused(() => reportHtml(report(), [], null), "type", "options");
    refused(() => reportHtml(report(), [], { inputs: "a.png" }), "type", "options.inputs");
    for (const made of [5, "2024-02-29", new Date(NaN)])
      refused(() => reportHtml(report(), [], { made }), "type", "options.made");
  });

  test("but words and numbers: a report that was kept as JSON has null for what is no number", () => {
    const kept = JSON.parse(JSON.stringify({ ...report(), covariance: new Array(36).fill(NaN), reason: undefined }));
    assert.ok(harmless(reportHtml(kept)).text.includes("not known"));
  });
});

test("an unfinished report is still a page", () => {
  const none = { share: NaN, sharpness: NaN };
  const empty = {
    ...{
      verdict: "undecided",
      reason: "",
      warnings: [],
      covariance: [],
      candidates: {},
      frames: [],
      sensitivity: [],
      cues: { edges: none },
    },
    health: { pixels: NaN, interval: [NaN, NaN] },
    estimate: { scale: 1, rotation: [], translation: [], angles: { alpha: NaN, beta: 0, gamma: 0 } },
  };
  const page = reportHtml(empty);
  harmless(page);
  assert.ok(!/NaN|undefined|Infinity/.test(page));
});

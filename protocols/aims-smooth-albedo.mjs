// The aims of objects whose albedo varies smoothly: renders, and photographs that no constant was set on.
import { aim } from "./aim.mjs";
import { FOUND_WITHIN, isConfidentlyWrong, isFlagged, isFound } from "./counts.mjs";
import { median, share } from "./numbers.mjs";
import { CONDITIONS } from "./unseen.mjs";

export function softAims(row) {
  if (!row) return [];
  const { cases, found } = row;
  return [
    aim("soft", `share under ${FOUND_WITHIN} degrees`, found / cases, ">=", 0.85, cases),
    aim("soft", "median degrees", row.medianOfAll, "<=", 1, cases),
    aim("soft", "share confidently wrong", row.confidentlyWrong / cases, "<=", 0, cases),
  ];
}

export function unseenAims(rows = []) {
  return CONDITIONS.flatMap(({ condition, limits }) => {
    const members = rows.filter((row) => row.condition === condition);
    const found = members.filter(isFound);
    const line = (what, measured, sense, limit, count = members.length) =>
      aim("unseen", `${condition}: ${what}`, measured, sense, limit, count);
    return [
      line("median degrees", median(members.map(({ degrees }) => degrees)), "<=", limits.median),
      line(`share under ${FOUND_WITHIN} degrees`, share(members, isFound), ">=", limits.found),
      line("share confidently wrong", share(members, isConfidentlyWrong), "<=", 0),
      line("share of the good ones flagged", share(found, isFlagged), "<=", 0.3, found.length),
    ];
  });
}

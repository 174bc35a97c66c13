/** Both surfaces and the curves of a run, drawn by the parts of the lessons' figures. Loads with the first element that shows them. */

import { dipInto } from "../dom";
import { Figure } from "../learn/figure";
import type { Panel } from "../learn/protocol";
import { styled } from "./styled";

/** The charts have a separate shadow root, because the element's style would otherwise affect the figure. */
export function chartsIn(host: HTMLElement): (panels: Panel[]) => void {
  const root = host.attachShadow({ mode: "open" });
  styled(root);
  const figure = new Figure(new Set(), new Set(), () => {});
  root.append(figure.element);
  return (panels) => {
    dipInto(root);
    figure.show({ panels, numbers: {} });
  };
}

/** Dark or light: the system's choice until the visitor makes one. */

import { forgetInks } from "./dom";
import { language, phrase } from "./words";

const KEY = "bimodal-stereo.theme";

/** Private windows may refuse storage; the choice then lasts as long as the page. */
function remembered(): string | null {
  try {
    return localStorage.getItem(KEY);
  } catch {
    return null;
  }
}

function remember(theme: string): void {
  try {
    localStorage.setItem(KEY, theme);
  } catch {
    // The choice is not stored, for the reason given above.
  }
}

/** Must be called before anything asynchronous, because a page that was left dark would otherwise flash when it returns. */
export function wearTheme(): void {
  const chosen = remembered();
  if (chosen === "dark" || chosen === "light") document.documentElement.dataset.theme = chosen;
}

export function themeToggle(button: HTMLButtonElement, onChange: () => void): void {
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const current = () => document.documentElement.dataset.theme ?? (dark.matches ? "dark" : "light");
  const label = () =>
    button.setAttribute(
      "aria-label",
      current() === "dark"
        ? phrase("theme.light", "Switch to the light theme")
        : phrase("theme.dark", "Switch to the dark theme"),
    );
  const change = () => {
    label();
    forgetInks();
    onChange();
  };
  label();
  language.addEventListener("changed", label);
  button.addEventListener("click", () => {
    const next = current() === "dark" ? "light" : "dark";
    document.documentElement.dataset.theme = next;
    remember(next);
    change();
  });
  dark.addEventListener("change", change);
}

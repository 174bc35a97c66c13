/** Fills the Lab's slots for own files as a visitor does. */

import type { Lab } from "./lab";
import type { Upload } from "./uploads";

export const slot = (lab: Lab, index: number) => lab.page.locator(".slot").nth(index);

export async function put(lab: Lab, label: string, file: Upload): Promise<void> {
  await lab.page.getByLabel(label, { exact: true }).setInputFiles(file);
}

export async function own(lab: Lab): Promise<void> {
  await lab.open("size=32");
  await lab.unfold();
  await lab.page.getByRole("button", { name: "Own files" }).click();
  await lab.reaches("waiting");
}

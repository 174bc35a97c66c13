/**
 * Numbers with labels, as people and programs print them: "fx 611.3", "T_cam_lidar:" above four rows, ost.txt of ROS, print() of Python,
 * assignments of arrays. The words before numbers are their name, and a line of only words is the name of the lines below it.
 */
import type { Node, Numbers } from "./numbers.js";
import { numberOf } from "./numbers.js";
import { plainPython } from "./settings.js";

/** Largest number of lines and numbers of such a text; calibrations have a few hundred. */
const MOST_LINES = 5000;
const MOST_NUMBERS = 20_000;
const LONGEST_NAME = 80;
/** Lines of a script that are not assignments. */
const CODE = /^\s*(?:import|from|def|class|print|return|if|for|while|with|using|#include|clear|close all|clc)\b/;
const TOKEN = /[^\s,;[\](){}=:"']+|[,;=:]/g;

/** The tokens of a line without the comments of Python, C and MATLAB. */
const tokensOf = (line: string): string[] => line.replace(/(?:^|\s)(?:#|\/\/|%).*$/, "").match(TOKEN) ?? [];

class Notes {
  readonly root: Node = {};
  #group = this.root;
  /** The last line of only words, until numbers follow. */
  #heading: string | undefined;
  /** The list that takes the next numbers. */
  #open: { name: string; rows: Numbers[] } | undefined;
  #isNewRow = true;
  #count = 0;

  line(text: string): boolean {
    if (CODE.test(text)) return true;
    if (text.trim() === "") this.#close();
    const section = /^\s*\[\s*([A-Za-z_][^\]\d,]{0,80})\]\s*$/.exec(text)?.[1];
    if (section !== undefined) {
      this.#close();
      this.#begin(section.trim());
      return true;
    }
    let [key, value]: [string[], string[] | undefined] = [[], undefined];
    this.#isNewRow = true;
    for (const token of tokensOf(text)) {
      const number = numberOf(token);
      if (number !== undefined) {
        if (key.length > 0) this.#name(key.join(" "));
        this.#add(number);
        [key, value] = [[], undefined];
      } else if (token === ":" || token === "=") {
        // If there are two names, as in "depth intrinsics: width: 640", the first one names the group.
        if (value !== undefined && value.length > 0) {
          this.#close();
          this.#begin(key.join(" "));
          key = value;
        }
        value = [];
      } else if (token === "," || token === ";") {
        this.#say(key, value);
        [key, value] = [[], undefined];
      } else (value ?? key).push(token);
      if (this.#count > MOST_NUMBERS) return false;
    }
    if (value !== undefined && value.length > 0) this.#say(key, value);
    else if (key.length > 0) this.#head(key.join(" "));
    return true;
  }

  /** "model: Brown Conrady" */
  #say(key: string[], value: string[] | undefined): void {
    if (key.length === 0 || value === undefined || value.length === 0) return;
    this.#close();
    this.#set(key.join(" "), value.join(" "));
  }

  #head(name: string): void {
    this.#close();
    if (this.#heading !== undefined) this.#begin(this.#heading);
    this.#heading = name;
  }

  #name(name: string): void {
    this.#close();
    if (this.#heading !== undefined) this.#begin(this.#heading);
    this.#heading = undefined;
    this.#open = { name, rows: [] };
  }

  #add(number: number): void {
    if (this.#open === undefined && this.#heading !== undefined) {
      this.#open = { name: this.#heading, rows: [] };
      this.#heading = undefined;
    }
    if (this.#open === undefined) return;
    if (this.#isNewRow || this.#open.rows.length === 0) this.#open.rows.push([]);
    this.#isNewRow = false;
    this.#open.rows.at(-1)?.push(number);
    this.#count++;
  }

  #begin(name: string): void {
    this.#group = {};
    this.#heading = undefined;
    const isNew = !Object.hasOwn(this.root, name);
    this.#put(this.root, isNew ? name : `${name} ${Object.keys(this.root).length}`, this.#group);
  }

  #close(): void {
    if (this.#open === undefined) return;
    const { name, rows } = this.#open;
    this.#open = undefined;
    const isMatrix = rows.length > 1 && rows.every((row) => row.length === rows[0]?.length && row.length > 1);
    const values = rows.flat();
    this.#set(name, isMatrix ? rows : values.length === 1 ? values[0] : values);
  }

  /** A repeated name begins another group, as in a list of cameras. */
  #set(name: string, value: unknown): void {
    if (Object.hasOwn(this.#group, name)) this.#begin(`${name} ${Object.keys(this.root).length}`);
    this.#put(this.#group, name, value);
  }

  #put(node: Node, name: string, value: unknown): void {
    if (name !== "__proto__" && name.length <= LONGEST_NAME) node[name] = value;
  }

  done(): Node {
    this.#close();
    return this.root;
  }
}

/** The numbers of a text by their names; undefined if there are too many. */
export function readNotes(text: string): Node | undefined {
  const lines = plainPython(text).split(/\r?\n/);
  if (lines.length > MOST_LINES) return undefined;
  const notes = new Notes();
  return lines.every((line) => notes.line(line)) ? notes.done() : undefined;
}

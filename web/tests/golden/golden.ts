/// <reference types="node" />
/** Numbers from the Python side; tools/make_studio_golden.py writes them. */

import { readFileSync } from "node:fs";
import { canonical, type FDVVModel } from "../../src/model";

/** Read the cases of a file. */
export function golden<Case>(name: string): Case[] {
  return JSON.parse(readFileSync(new URL(`./${name}.json`, import.meta.url), "utf8")) as Case[];
}

/** Read a model that is shipped. */
export function builtIn(name: string): FDVVModel {
  const file = new URL(`../../../packages/fdvv/src/fdvv/model/builtin/${name}.fdvv.json`, import.meta.url);
  return canonical(JSON.parse(readFileSync(file, "utf8")));
}

/** Read a model of the golden files. */
export function example(name: string): FDVVModel {
  const found = golden<FDVVModel>("models").find((model) => model.name === name);
  if (!found) throw new Error(`no golden model ${name}`);
  return found;
}

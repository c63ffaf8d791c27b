/** What was worked on: own buttons, jobs, runs and studies, the newest of each. */

import { askAbsent, packageOf } from "../../app/absent";
import { address } from "../../app/route";
import { call } from "../../net";

export interface Entry {
  readonly to: string;
  readonly name: string;
  /** What it is now, in a few words. */
  readonly about: string;
}

export interface Group {
  readonly title: string;
  readonly entries: readonly Entry[];
}

const MANY = 4;
const ASKED: readonly (readonly [page: string, title: string, ask: () => Promise<readonly Entry[]>])[] = [
  ["edit", "Your buttons", buttons],
  ["live", "Jobs on a rig", jobs],
  ["optimize", "Optimisations", runs],
  ["studies", "Studies", studies],
];

/** Return the groups that have something in them; what cannot be listed is reported by `wrong`. */
export async function recent(wrong: (error: unknown) => void): Promise<Group[]> {
  await askAbsent();
  const found = ASKED.filter(([page]) => !packageOf(page)).map(async ([, title, ask]) => {
    const entries = await ask().catch((error: unknown) => {
      wrong(error);
      return [];
    });
    return { title, entries: entries.slice(0, MANY) };
  });
  return (await Promise.all(found)).filter(({ entries }) => entries.length);
}

async function buttons(): Promise<Entry[]> {
  const { rows } = await call("document.list", {});
  return rows.map(({ button, name, changed_s }) => ({
    to: address("edit", button),
    name,
    about: `changed ${new Date(changed_s * 1000).toLocaleDateString()}`,
  }));
}

async function jobs(): Promise<Entry[]> {
  const { jobs: rows } = await call("jobs.list", {});
  return rows.map(({ job, kind, title, state, simulated }) => ({
    to: address("live", kind === "probe" ? "compensate" : kind, { job }),
    name: title,
    about: simulated ? `${state}, simulated` : state,
  }));
}

async function runs(): Promise<Entry[]> {
  const { rows } = await call("optimize.list", {});
  return rows.map(({ run, title, spent, budget, preference }) => ({
    to: address("optimize", String(run)),
    name: title,
    about: `${spent} of ${budget} ${preference ? "comparisons" : "trials"}`,
  }));
}

async function studies(): Promise<Entry[]> {
  const { rows } = await call("studies.list", {});
  return rows.map(({ name, title, state, people, planned }) => ({
    to: address("studies", name),
    name: title || name,
    about: `${state}, ${people} of ${planned} people`,
  }));
}

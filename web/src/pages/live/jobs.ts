/** The jobs as the server tells them: all rows, and the events of the one that is looked at. */

import { call, type JobRow, type LiveChannel, live, type StartJob } from "../../net";
import { type Signal, signal, tell, toast, untracked } from "../../ui";
import { emptyPicture, fold, type JobEvent, type JobPicture } from "./picture";
import { jobAddress } from "./where";

export type Order = StartJob["order"];

/** All jobs, newest first; null until the server has answered. */
export const rows: Signal<readonly JobRow[] | null> = signal<readonly JobRow[] | null>(null);

/** The job that is looked at and what its events come to. */
export const watched: Signal<Watched> = signal<Watched>({ job: "", events: 0, picture: emptyPicture() });

export interface Watched {
  readonly job: string;
  /** So many events are in the picture. */
  readonly events: number;
  readonly picture: JobPicture;
}

const channel = live().channel("jobs", {
  opened: (channel) => {
    channel.send({ type: "watch_jobs" });
    askEvents(channel);
  },
  onMessage: (message) => {
    if (message.type === "jobs") rows.set(message.jobs.map(heard));
    else if (message.type === "job") changed(message.row);
    else take(message.job, message.from_event, message.events);
  },
  wrong: (line) => toast(line, "wrong"),
});

const heard_ms = new WeakMap<JobRow, number>();

/** When a row was heard of: what is left of its time counts from then. */
export function heardAt_ms(row: JobRow): number {
  return heard_ms.get(row) ?? performance.now();
}

function heard(row: JobRow): JobRow {
  heard_ms.set(row, performance.now());
  return row;
}

function changed(row: JobRow): void {
  heard(row);
  const known = rows.peek() ?? [];
  const there = known.some((one) => one.job === row.job);
  rows.set(there ? known.map((one) => (one.job === row.job ? row : one)) : [row, ...known]);
}

/** Look at a job: its events so far arrive first, then each new one. Empty looks at none. */
export function watchJob(job: string): void {
  if (untracked(() => watched().job) === job) return;
  watched.set({ job, events: 0, picture: emptyPicture() });
  askEvents(channel);
}

function askEvents(channel: LiveChannel<"jobs">): void {
  const { job, events } = watched.peek();
  if (job) channel.send({ type: "watch_job", job, from_event: events });
}

/** Take events in; what is there already is passed over, after a gap they are asked for anew. */
function take(job: string, from_event: number, events: readonly JobEvent[]): void {
  const now = watched.peek();
  if (job !== now.job) return;
  if (from_event > now.events) return askEvents(channel);
  const fresh = events.slice(now.events - from_event);
  if (fresh.length)
    watched.set({ job, events: now.events + fresh.length, picture: fresh.reduce(fold, now.picture) });
}

export function rowOf(job: string): JobRow | null {
  return rows()?.find((row) => row.job === job) ?? null;
}

/** Start work, and look at it. */
export async function begin(order: Order): Promise<void> {
  const row = await done(call("jobs.start", { order }));
  if (row) location.hash = jobAddress(row);
}

export const cancelJob = (job: string) => done(call("jobs.cancel", { job }));
export const resumeJob = (job: string) => done(call("jobs.resume", { job }));
export const answerJob = (job: string, number: number, answer: string) =>
  done(call("jobs.answer", { job, number, answer }));

/** Return the row after what was asked; null if the studio refused, which is then shown. */
async function done(asked: Promise<JobRow>): Promise<JobRow | null> {
  try {
    const row = await asked;
    changed(row);
    return row;
  } catch (error) {
    tell(error);
    return null;
  }
}

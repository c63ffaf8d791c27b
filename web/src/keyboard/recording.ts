/** A key's depth as a file: CSV of t_ms and depth_mm under a few lines that say what was recorded. */

export interface Recording {
  readonly device: string;
  readonly key: string;
  /** Reports a second, as they came. */
  readonly rate_Hz: number;
  /** What the person said of the travel; depths are parts of it. */
  readonly full_scale_mm: number;
  /** How it was made, if not by a key; empty if it was recorded. */
  readonly simulated: string;
  readonly t_ms: readonly number[];
  readonly depth_mm: readonly number[];
}

const FIRST = "# fdvv key recording 1";
const COLUMNS = "t_ms,depth_mm";
export const LARGEST_bytes = 4_000_000;
export const LONGEST_ms = 120_000;
const DEEPEST_mm = 10;
const FEWEST = 4;

export function recordingText(recording: Recording): string {
  const { device, key, rate_Hz, full_scale_mm, simulated, t_ms, depth_mm } = recording;
  const line = (text: string) => text.replaceAll(/\s+/g, " ");
  return [
    FIRST,
    `# device: ${line(device)}`,
    `# key: ${line(key)}`,
    `# rate_Hz: ${Math.round(rate_Hz)}`,
    `# full_scale_mm: ${full_scale_mm}`,
    ...(simulated ? [`# simulated: ${line(simulated)}`] : []),
    COLUMNS,
    ...t_ms.map((t, i) => `${Number(t.toFixed(2))},${Number((depth_mm[i] as number).toFixed(4))}`),
    "",
  ].join("\n");
}

/** Read a recording. Throws an Error of one line with file, line and reason. */
export function readRecording(text: string, name: string): Recording {
  const wrong = (line: number, reason: string) => new Error(`${name}: line ${line}: ${reason}`);
  if (text.length > LARGEST_bytes) throw new Error(`${name} is larger than 4 MB; record less`);
  const lines = text.replace(/^\uFEFF/, "").split(/\r?\n/);
  if (lines[0]?.trim() !== FIRST) throw wrong(1, `a recording of a key begins with ${JSON.stringify(FIRST)}`);
  const header = lines.findIndex((line) => !line.startsWith("#"));
  if (lines[header]?.trim() !== COLUMNS)
    throw wrong(header < 0 ? lines.length : header + 1, `the columns ${COLUMNS} are missing`);
  const facts = factsOf(lines.slice(1, header));
  const [t_ms, depth_mm] = columns(lines, header + 1, wrong);
  if (t_ms.length < FEWEST)
    throw new Error(`${name}: ${t_ms.length} rows; a recording needs ${FEWEST} or more`);
  const start_ms = t_ms[0] as number;
  return { ...facts, t_ms: t_ms.map((t) => t - start_ms), depth_mm };
}

function factsOf(lines: readonly string[]): Omit<Recording, "t_ms" | "depth_mm"> {
  const facts = new Map(
    lines.map((line) => {
      const [, name, value] = /^#\s*(\w+):\s*(.*?)\s*$/.exec(line) ?? [];
      return [name, value ?? ""] as const;
    }),
  );
  const number = (name: string, otherwise: number) => {
    const found = Number(facts.get(name) || "x");
    return Number.isFinite(found) && found > 0 ? found : otherwise;
  };
  return {
    device: facts.get("device") || "unknown keyboard",
    key: facts.get("key") || "unknown key",
    rate_Hz: number("rate_Hz", 0),
    full_scale_mm: number("full_scale_mm", 4),
    simulated: facts.get("simulated") ?? "",
  };
}

function columns(
  lines: readonly string[],
  from: number,
  wrong: (line: number, reason: string) => Error,
): readonly [number[], number[]] {
  const [t_ms, depth_mm]: [number[], number[]] = [[], []];
  for (const [i, line] of lines.entries()) {
    if (i < from || !line.trim()) continue;
    const cells = line.split(",");
    const [t, depth] = cells.map((cell) => (cell.trim() ? Number(cell) : Number.NaN)) as [number, number];
    if (cells.length !== 2 || !Number.isFinite(t) || !Number.isFinite(depth))
      throw wrong(i + 1, `${JSON.stringify(line.slice(0, 40))} is no pair of numbers`);
    if (Math.abs(depth) > DEEPEST_mm)
      throw wrong(i + 1, `${depth} mm is deeper than a key, ${DEEPEST_mm} mm`);
    if (t_ms.length && t < (t_ms.at(-1) as number))
      throw wrong(i + 1, "its time is before that of the last row");
    if (t - (t_ms[0] ?? t) > LONGEST_ms) throw wrong(i + 1, "a recording lasts 120 s at most");
    t_ms.push(t);
    depth_mm.push(depth);
  }
  return [t_ms, depth_mm];
}

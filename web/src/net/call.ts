/** Questions to the studio's server. */

import type { Calls } from "./messages";

/** What the server said in one line. status 0: it could not be reached. */
export class StudioError extends Error {
  constructor(
    line: string,
    readonly status: number,
  ) {
    super(line);
  }
}

const GONE = "the studio does not answer; is `fdvv studio` still running?";

/** Ask; throws StudioError with one line for the person. */
export async function call<K extends keyof Calls>(
  name: K,
  ask: Calls[K]["ask"],
  signal?: AbortSignal,
): Promise<Calls[K]["answer"]> {
  let response: Response;
  try {
    response = await fetch(`./api/${name}`, {
      method: "POST",
      headers: { "content-type": "application/json" },
      body: JSON.stringify(ask),
      signal: signal ?? null,
    });
  } catch (error) {
    if (error instanceof DOMException && error.name === "AbortError") throw error;
    throw new StudioError(GONE, 0);
  }
  if (response.ok) return (await response.json()) as Calls[K]["answer"];
  throw new StudioError(await reason(response), response.status);
}

async function reason(response: Response): Promise<string> {
  const text = await response.text();
  try {
    return (JSON.parse(text) as { error: string }).error;
  } catch {
    return text || `the studio refused (${response.status})`;
  }
}

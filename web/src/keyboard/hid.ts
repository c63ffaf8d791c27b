/** Analog keyboards that the browser reaches by WebHID. */

import { type DeviceIdentity, FORMATS, formatOf, parseReport, type ReportFormat } from "./reports";

/** What of WebHID (wicg.github.io/webhid) is used; the compiler's library does not have it. */
interface InputReport extends Event {
  readonly data: DataView;
  readonly reportId: number;
}
interface Device extends DeviceIdentity, EventTarget {
  readonly productName: string;
  readonly opened: boolean;
  open(): Promise<void>;
  close(): Promise<void>;
}
interface Hid extends EventTarget {
  getDevices(): Promise<readonly Device[]>;
  requestDevice(options: { readonly filters: readonly object[] }): Promise<readonly Device[]>;
}

export const UNSUPPORTED =
  "This browser does not let a page read how deep a key is: use Chrome, Edge or Opera on a computer, and open " +
  "the studio on the same machine or over https.";

/** What a keyboard says: keys that are down, from one of its interfaces, or one line of what went wrong. */
export interface Heard {
  readonly keys: (format: ReportFormat, keys: ReadonlyMap<number, number>, at_ms: number) => void;
  readonly problem: (line: string) => void;
  readonly lost: () => void;
}

/** A keyboard that is open until close(). */
export interface OpenKeyboard {
  readonly name: string;
  close(): void;
}

function hid(): Hid | undefined {
  return (navigator as Navigator & { readonly hid?: Hid }).hid;
}

export function supported(): boolean {
  return hid() !== undefined;
}

/**
 * Open a keyboard and listen to all of its interfaces that are known.
 *
 * another: let the person choose one, even if the page may use one already. null if none was chosen.
 * Throws an Error of one line where none can be read.
 */
export async function openKeyboard(heard: Heard, another = false): Promise<OpenKeyboard | null> {
  const system = hid();
  if (!system) throw new Error(UNSUPPORTED);
  const known = (devices: readonly Device[]) => devices.filter((device) => formatOf(device));
  let devices = another ? [] : known(await system.getDevices());
  if (!devices.length) {
    const chosen = await system.requestDevice({ filters: FORMATS.flatMap(({ filters }) => filters) });
    if (!chosen.length) return null;
    devices = known(chosen);
  }
  const [first] = devices;
  if (!first) throw new Error("this keyboard has no interface that tells how deep its keys are");
  // the interfaces of one keyboard, not of all that the page may use
  const own = devices.filter(
    ({ productId, vendorId }) => productId === first.productId && vendorId === first.vendorId,
  );
  return listening(system, own, first.productName || "unnamed keyboard", heard);
}

async function listening(
  system: Hid,
  devices: readonly Device[],
  name: string,
  heard: Heard,
): Promise<OpenKeyboard> {
  const take = (event: Event) => {
    const { data, reportId, timeStamp, target } = event as InputReport;
    const format = formatOf(target as Device) as ReportFormat;
    const { keys, problem } = parseReport(format, data, reportId);
    if (problem !== undefined) heard.problem(problem);
    else heard.keys(format, new Map(keys.map(({ code, ratio }) => [code, ratio])), timeStamp);
  };
  const close = () => {
    system.removeEventListener("disconnect", gone);
    for (const device of devices) {
      device.removeEventListener("inputreport", take);
      void device.close().catch(() => undefined);
    }
  };
  const gone = (event: Event) => {
    if (!devices.includes((event as Event & { readonly device: Device }).device)) return;
    close();
    heard.lost();
  };
  system.addEventListener("disconnect", gone);
  try {
    for (const device of devices) {
      device.addEventListener("inputreport", take);
      if (!device.opened) await device.open();
    }
  } catch (error) {
    close();
    const reason = error instanceof Error ? error.message : String(error);
    throw new Error(`${name} cannot be opened: ${reason} (on Linux a udev rule must allow it)`);
  }
  return { name, close };
}

/** What the connected device tells while it is looked at. */

import { type DeviceStatus, live, type PressSeen } from "../../net";
import { effect, onCleanup, type Signal, signal, toast } from "../../ui";
import { type ScopeBins, withBins } from "./scope";

/** Pixel columns that a device's ticks are sent in. */
export const COLUMNS = 600;

export const span_s: Signal<number> = signal(5);
export const seen: Signal<PressSeen | null> = signal<PressSeen | null>(null);
export const scope: Signal<ScopeBins> = signal<ScopeBins>({ bin_s: 5 / COLUMNS, bins: [] });

const NONE: DeviceStatus = { type: "standing" };
const received = signal<DeviceStatus>(NONE);

export type Status = Required<DeviceStatus>;
const DEFAULTS: Status = {
  type: "standing",
  device: "",
  name: "",
  simulated: false,
  streams: false,
  person: false,
  force_sensor: false,
  tick_s: 0,
  mode: "",
  programmed: "",
  travel_mm: null,
  fault: "",
  loop: "",
  missing_ticks: 0,
  late_ticks: 0,
  missing_frames: 0,
  lost_records: 0,
};

/** How the device is. */
export const standing = Object.assign((): Status => ({ ...DEFAULTS, ...received() }), {
  set: (value: DeviceStatus) => received.set(value),
});

/** Look on for as long as the scope in which this is called lasts. */
export function followDevice(): void {
  const channel = live().channel("scope", {
    onMessage: (message) => {
      if (message.type === "standing") received.set(message);
      else if (message.type === "press_seen") seen.set(message);
      else scope.update((kept) => withBins(kept, message, COLUMNS));
    },
    wrong: (line) => toast(line, "wrong"),
  });
  effect(() => {
    const bin_s = span_s() / COLUMNS;
    if (live().state() !== "open") return;
    scope.set({ bin_s, bins: [] });
    channel.send({ type: "watch_scope", bin_s });
  });
  onCleanup(() => channel.close());
}

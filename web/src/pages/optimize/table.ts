/** What is pressed: a simulated button under the page's own hand, or a device on the table beside it. */

import { call } from "../../net";
import type { Offer } from "../../net/messages";
import { choice, h, type Signal, signal } from "../../ui";

/** No device: the simulated button. */
export const SIMULATED = "";
const HERE = "a simulated button, with key, mouse or touch";

export interface Table {
  /** The device that is pressed; SIMULATED if none is. */
  readonly device: Signal<string>;
  /** Where one chooses; nothing where there is no device. */
  readonly element: HTMLElement;
}

export function table(busy: () => boolean): Table {
  const device = signal(SIMULATED);
  const devices = signal<readonly Offer[]>([]);
  // without devices there is nothing to choose, whatever the reason
  call("optimize.devices", {}).then(
    (found) => devices.set(found.devices),
    () => undefined,
  );
  const options = () => [
    [SIMULATED, HERE] as const,
    ...devices().map(
      (device) => [device.name, device.told ? `${device.name}, ${device.told}` : device.name] as const,
    ),
  ];
  const element = h("span", {}, () =>
    devices().length && !busy()
      ? choice({ label: "Press on", options: options(), value: device, set: device.set })
      : null,
  );
  return { device, element };
}

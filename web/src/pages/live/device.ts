/** A device held open: connect, look at it, upload, press, arm, stop; one key brings zero force. */

import { type Calls, call, type DeviceStatus, type SelfTest, type WorkChoices } from "../../net";
import {
  addShortcuts,
  button,
  type Child,
  choice,
  computed,
  effect,
  empty,
  h,
  numberField,
  panel,
  signal,
  tell,
  untracked,
} from "../../ui";
import { buttonOptions, choices, deviceOptions, refreshChoices } from "./choices";
import { bound } from "./compensateform";
import { followDevice, standing } from "./looking";
import { pressPanel } from "./pressview";
import { scopePanel } from "./scopeview";

const draft = {
  device: signal("host"),
  rig: signal("recommended"),
  seed: signal(0),
  button: signal(""),
  actuation: signal(""),
  speed: signal(100),
};
const facts = signal<readonly (readonly [string, string])[]>([]);
const tested = signal<SelfTest | null>(null);

export function deviceView(): Child {
  followDevice();
  const connected = computed(() => standing().device);
  addShortcuts({
    keys: "Escape",
    does: "Zero force now",
    act: () => void (connected() && ask("device.stop", {})),
  });
  effect(() => {
    connected();
    facts.set([]);
    tested.set(null);
  });
  return () => (connected() ? untracked(connectedView) : untracked(connectView));
}

type DeviceCall = Exclude<Extract<keyof Calls, `device.${string}`>, "device.facts" | "device.selftest">;

/** Ask something of the device; what it is like afterwards is shown. */
async function ask<K extends DeviceCall>(name: K, about: Calls[K]["ask"]): Promise<void> {
  try {
    standing.set((await call(name, about)) as DeviceStatus);
  } catch (error) {
    tell(error);
  }
}

function connectView(): Child {
  const gone = () => (standing().fault ? h("p", { class: "wrong", role: "alert" }, standing().fault) : null);
  const fields = () => {
    const found = choices();
    return found ? connectFields(found) : h("p", { class: "muted" }, "…");
  };
  const again = button({ label: "Rescan", act: refreshChoices, hint: "List the serial ports again" });
  return h(
    "div",
    { class: "stack" },
    gone,
    panel("Connect a device", fields, h("div", { class: "row" }, again)),
    empty("No device is connected", "Connect one to monitor it, test it, and press a button on it."),
  );
}

function connectFields(found: WorkChoices): Child {
  const start = button({
    label: "Connect",
    kind: "main",
    act: () =>
      void ask("device.connect", {
        device: draft.device.peek(),
        rig: draft.rig.peek(),
        seed: draft.seed.peek(),
      }),
  });
  return [
    h(
      "div",
      { class: "work-fields" },
      choice({ label: "Device", options: deviceOptions(found, "rig"), ...bound(draft.device) }),
      choice({
        label: "Simulated rig",
        options: found.rigs.map((name) => [name, name]),
        ...bound(draft.rig),
      }),
      numberField({
        label: "Seed of the simulation",
        unit: "",
        ...bound(draft.seed),
        least: 0,
        most: 2 ** 31,
        digits: 0,
      }),
      start,
    ),
    found.note ? h("p", { class: "muted" }, found.note) : null,
    h(
      "ul",
      { class: "device-list" },
      found.devices.map((device) =>
        h(
          "li",
          {},
          h("strong", {}, device.device),
          ` ${device.about}${device.used_by ? `; in use by ${device.used_by}` : ""}`,
        ),
      ),
    ),
  ];
}

function connectedView(): Child {
  return [
    panel(standing().device, status(), controls()),
    scopePanel(),
    h("div", { class: "two" }, pressPanel(), panel("About", aboutView())),
  ];
}

function status(): Child {
  const s = standing;
  const counted = () =>
    `${s().missing_ticks} ticks missing, ${s().late_ticks} late, ${s().missing_frames} frames lost, ${s().lost_records} records dropped`;
  return h(
    "div",
    { class: "stack" },
    h(
      "div",
      { class: "row" },
      h("strong", {}, () => s().name),
      h("span", { class: "tag simulated", hidden: () => !s().simulated }, "simulated"),
      h("span", { class: () => `job-state mode-${s().mode}`, hidden: () => !s().mode }, () => s().mode),
      h("span", { class: "muted" }, () =>
        s().programmed
          ? `program: ${s().programmed}, travel ${s().travel_mm?.toFixed(2) ?? "?"} mm`
          : "no program yet",
      ),
    ),
    h("p", { class: "muted", hidden: () => !s().streams }, counted),
    h(
      "p",
      { class: "wrong", role: "alert", hidden: () => !s().fault },
      () => `Fault, zero force: ${s().fault}`,
    ),
  );
}

function controls(): Child {
  const streams = () => standing().streams;
  const clear = button({ label: "Clear the fault", act: () => void ask("device.clear_fault", {}) });
  return [
    h("div", { class: "work-fields" }, () => programFields()),
    h(
      "div",
      { class: "row" },
      h("span", { hidden: () => standing().person }, pressControl()),
      h(
        "span",
        { hidden: () => !streams() },
        button({
          label: "Arm",
          act: () => void ask("device.arm", {}),
          disabled: () => !standing().programmed,
          hint: "Render the program until you stop it",
        }),
      ),
      h(
        "span",
        { hidden: () => !streams() },
        button({ label: "Zero force (Esc)", kind: "danger", act: () => void ask("device.stop", {}) }),
      ),
      h("span", { hidden: () => !standing().fault }, clear),
      button({
        label: "Disconnect",
        act: () => void ask("device.disconnect", {}).then(refreshChoices),
        hint: "Zero force, then disconnect",
      }),
    ),
  ];
}

function programFields(): Child {
  const found = choices();
  if (!found) return "…";
  const options = buttonOptions(found);
  if (!draft.button.peek()) draft.button.set(options[0]?.[0] ?? "");
  const tables = [
    ["", "own force"],
    ...found.actuations.map((name): [string, string] => [name, name]),
  ] as const;
  const upload = () =>
    ask("device.upload", { button: draft.button.peek(), actuation: draft.actuation.peek() });
  return [
    choice({ label: "Button", options, ...bound(draft.button) }),
    choice({ label: "Learned table", options: tables, ...bound(draft.actuation) }),
    button({ label: "Upload", kind: "main", act: () => void upload() }),
  ];
}

function pressControl(): HTMLElement {
  const press = button({
    label: "Press once",
    kind: "main",
    disabled: () => !standing().programmed,
    act: () => void ask("device.press", { velocity_mm_s: draft.speed.peek() }),
    hint: "The simulated finger presses",
  });
  return h(
    "span",
    { class: "row" },
    numberField({ label: "at", unit: "mm/s", ...bound(draft.speed), least: 5, most: 500, digits: 0 }),
    press,
  );
}

function aboutView(): Child {
  const read = async () => {
    try {
      facts.set((await call("device.facts", {})).facts.map((fact) => [fact.name, fact.value]));
    } catch (error) {
      tell(error);
    }
  };
  const test = async () => {
    try {
      tested.set(await call("device.selftest", {}));
    } catch (error) {
      tell(error);
    }
  };
  return h(
    "div",
    { class: "stack" },
    h(
      "div",
      { class: "row" },
      button({ label: "Read", act: () => void read() }),
      button({ label: "Self-test", act: () => void test() }),
    ),
    () => verdicts(tested()),
    () => factList(facts()),
  );
}

function factList(found: readonly (readonly [string, string])[]): Child {
  if (!found.length) return null;
  return h(
    "dl",
    { class: "facts" },
    found.map(([name, value]) => h("div", {}, h("dt", {}, name), h("dd", {}, value))),
  );
}

function verdicts(found: SelfTest | null): Child {
  if (!found) return null;
  if (found.note) return h("p", { class: "muted" }, found.note);
  return h(
    "ul",
    { class: "verdicts" },
    found.parts.map((part) =>
      h(
        "li",
        { class: part.verdict },
        h("span", {}, part.part.replace(/_/g, " ")),
        h("strong", {}, part.verdict.replace(/_/g, " ")),
        h("span", { class: "muted" }, `${part.value}`),
      ),
    ),
  );
}

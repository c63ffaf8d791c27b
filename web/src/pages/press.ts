/** Press: feel a button under a simulated finger. */

import { keepQuery, type Route } from "../app/route";
import type { Page } from "../app/types";
import { download } from "../draw";
import { wavOf } from "../math/wav";
import { call } from "../net";
import type { PressList } from "../net/messages";
import { addShortcuts, button, effect, h, onCleanup, scope, tell, untracked } from "../ui";
import { Chooser, type Pick } from "./press/choose";
import { replayPanel } from "./press/replay";
import { rendered } from "./press/sound";
import { type Mode, type PressStage, pressStage } from "./press/stage";
import "./press/press.css";

const RATE_Hz = 48_000;
const SECOND = "button builtin:mx-brown";

export const page: Page = {
  title: "Press",
  mount(host, route) {
    const place = h("div", { class: "press-page" }, h("p", { class: "muted" }, "…"));
    host.append(place);
    const stage = pressStage(place, { extra: tools });
    place.firstElementChild?.remove();
    // what comes after the answer ends with the page too
    let [leave, gone] = [() => undefined as void, false];
    onCleanup(() => {
      gone = true;
      leave();
    });
    call("press.list", {}).then((list) => {
      if (!gone) leave = scope(() => begin(place, stage, list, route));
    }, tell);
  },
};

function begin(place: HTMLElement, stage: PressStage, list: PressList, route: Route): void {
  const chooser = new Chooser(list, pickOf(route), { item: SECOND, mode: "intended", rig: "recommended" });
  place.prepend(chooser.element);
  stage.element.querySelector(".press-left")?.append(replayPanel(stage.session, list.traces));
  addShortcuts({ keys: "X", does: "Swap A and B, also while pressing", act: () => chooser.swap() });
  effect(() => {
    const choice = chooser.choiceNow();
    const { item, mode, rig } = chooser.now();
    untracked(() => {
      stage.start(choice);
      if (chooser.side() === "A") keepQuery({ press: item, mode, rig });
    });
  });
}

/** Read from the address what to press: `#/press/builtin:mx-clear`, or what was pressed last. */
function pickOf(route: Route): Pick {
  const item = route.id ? `button ${route.id}` : (route.query.get("press") ?? "button builtin:mx-clear");
  return {
    item,
    mode: (route.query.get("mode") as Mode | null) ?? "intended",
    rig: route.query.get("rig") ?? "recommended",
  };
}

function tools(stage: PressStage): HTMLElement {
  const session = stage.session;
  const signals = () => session.ready()?.signals ?? [];
  const save = async () => {
    const first = signals()[0];
    if (!first) return;
    const velocity_mm_s = session.lastPress.peek()?.velocity_mm_s ?? 100;
    download(
      `${session.ready.peek()?.name ?? "click"}.wav`,
      new Blob([wavOf(await rendered(first, velocity_mm_s, RATE_Hz), RATE_Hz, "float32")], {
        type: "audio/wav",
      }),
    );
  };
  return h(
    "div",
    { class: "row" },
    button({
      label: "Save the click",
      act: () => void save().catch(tell),
      hint: "The sound of the last press as a WAV file",
      disabled: () => !signals().length,
    }),
    button({
      label: "Break its sensor",
      act: () => session.fail(),
      hint: "See what the firmware does when its position sensor dies",
    }),
    button({
      label: "Host event 0",
      act: () => session.hostEvent(0),
      hint: "An event from the host, such as the end of a cooldown",
    }),
  );
}

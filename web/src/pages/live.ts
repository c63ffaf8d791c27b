/** Live work: capture, compensate, tune, devices; with all jobs always in view. */

import type { Page } from "../app/types";
import { type Child, computed, effect, h, on, panel, tabs, untracked } from "../ui";
import { captureForm } from "./live/captureform";
import { choices, refreshChoices } from "./live/choices";
import { compensateForm } from "./live/compensateform";
import { deviceView } from "./live/device";
import { jobHead } from "./live/head";
import { rowOf, rows, watchJob } from "./live/jobs";
import { learnView } from "./live/learn";
import { jobList } from "./live/list";
import { tuneView } from "./live/question";
import { captureView } from "./live/takes";
import { tuneForm } from "./live/tuneform";
import { goToSection, SECTIONS, type Section, section, shownJob } from "./live/where";
import "./live/live.css";

export const page: Page = {
  title: "Live work",
  followsRoute: true,
  mount(host) {
    const choosing = tabs({ label: "Kind of work", tabs: SECTIONS, value: section, set: goToSection });
    followChoices();
    const place = computed(() => `${section()} ${shownJob()}`);
    host.append(
      h("div", { class: "row spread" }, h("h1", {}, "Live work"), choosing),
      h(
        "div",
        { class: "live" },
        h("div", { class: "live-main stack" }, on(place, content)),
        h("aside", { class: "live-side" }, jobList()),
      ),
    );
    effect(() => watchJob(shownJob()));
  },
};

/** Ask what there is to choose from, and again whenever something was made. */
function followChoices(): void {
  const made = computed(() => (rows() ?? []).reduce((sum, row) => sum + row.results.length, 0));
  effect(() => {
    made();
    refreshChoices();
  });
}

function content(): Child {
  const now = section();
  if (now === "device") return deviceView();
  const job = shownJob();
  return job ? jobView(job, now) : setUp(now);
}

const FORMS = { compensate: compensateForm, capture: captureForm, tune: tuneForm } as const;
const ABOUT: Readonly<Record<keyof typeof FORMS, readonly [string, string]>> = {
  compensate: [
    "Compensate",
    "A rig adds its own mass, friction and delay. The studio presses it and learns the command table that makes it feel like the button.",
  ],
  capture: [
    "Capture",
    "Press a real button at several speeds, guided by a moving cue; the recording becomes your own model.",
  ],
  tune: ["Tune vibration", "Compare vibrations blind, two at a time; the best become the button's."],
};

function setUp(now: keyof typeof FORMS): Child {
  const [title, text] = ABOUT[now];
  const there = computed(() => choices() !== null);
  return panel(title, h("p", { class: "muted" }, text), () =>
    there() ? untracked(FORMS[now]) : h("p", { class: "muted" }, "…"),
  );
}

const VIEWS: Readonly<Record<Exclude<Section, "device">, () => Child>> = {
  compensate: learnView,
  capture: captureView,
  tune: tuneView,
};

function jobView(job: string, now: Exclude<Section, "device">): Child {
  const there = computed(() => rowOf(job) !== null);
  return [jobHead(job), () => (there() ? untracked(VIEWS[now]) : null)];
}

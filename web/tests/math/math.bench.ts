/** How long a page computes for one frame of a drag: `npx vitest bench --run`. */

import { bench } from "vitest";
import {
  constrain,
  force_cN,
  integralWeights,
  landmarks,
  linspace,
  surface,
  surfaceGrid,
} from "../../src/math";
import { History, movePoints } from "../../src/model";
import { builtIn } from "../golden/golden";

const clear = builtIn("mx-clear");
const x = linspace(0, 4, 400);
const out = new Float64Array(400);
const [v, wide] = surfaceGrid(clear, "press", 40, 120);
const slow = clear.curves[0]!;
const weights = integralWeights(slow, 0, 4);
const points = { stroke: "press", velocity_mm_s: 0.5, indices: [4] } as const;

bench("landmarks and 10 curves at 400 places", () => {
  landmarks(clear);
  for (let i = 0; i < 10; i++) force_cN(clear.curves[i % clear.curves.length]!, x, out);
});

bench("a surface of 40 velocities at 120 places", () => {
  surface(clear, "press", v, wide);
});

bench("constraints: work, ends and monotone together", () => {
  const wanted = slow.control_points_cN.map((c, i) => (i === 5 ? c + 3 : c));
  const rules = { keepWork: true, keepEnds: true, monotone: "rising" } as const;
  constrain(slow.control_points_cN, wanted, new Set([5]), rules, { weights, wanted: 270 });
});

const history = new History(clear);
history.mark("move");
let delta = 0;
bench("one move of a drag, the whole model checked", () => {
  delta += 0.01;
  history.drag(movePoints([points], delta % 5, { keepWork: true }));
});

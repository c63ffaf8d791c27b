import { describe, expect, it } from "vitest";
import {
  type Corner,
  FIRST_TURN,
  facesFromBehind,
  frontEdges,
  seen,
  turned,
} from "../../../src/pages/edit/surface_scene";

const flat = { around_rad: 0, tilt_rad: 0 };
const above = { around_rad: 0, tilt_rad: Math.PI / 2 };

describe("the box of the surface", () => {
  it("seen from the front shows displacement against force, from above displacement against velocity", () => {
    expect(seen([0.3, 0.9, 0.4], flat)).toMatchObject({ x: 0.3, y: -0.4 });
    const top = seen([0.3, 0.9, 0.4], above);
    expect([top.x, top.y]).toEqual([0.3, expect.closeTo(-0.9, 12)]);
  });

  it("is turned without being bent: lengths stay", () => {
    const [a, b]: [Corner, Corner] = [
      [-1, 0.2, 0.5],
      [0.3, -0.7, 1],
    ];
    const length = Math.hypot(...a.map((v, i) => v - b[i]!));
    for (const turn of [FIRST_TURN, turned(FIRST_TURN, 2.1, 0.3), above]) {
      const [p, q] = [seen(a, turn), seen(b, turn)];
      expect(Math.hypot(p.x - q.x, p.y - q.y, p.behind - q.behind)).toBeCloseTo(length, 12);
    }
  });

  it("is never seen from below", () => {
    expect(turned(FIRST_TURN, 0, -9).tilt_rad).toBe(0);
    expect(turned(FIRST_TURN, 0, 9).tilt_rad).toBe(Math.PI / 2);
  });

  it("has its axes at the edges in front, whichever way it is turned", () => {
    for (let around = -7; around < 7; around += 0.37) {
      const turn = { around_rad: around, tilt_rad: 0.5 };
      const { displacementAtBack: back, velocityAtRight: right } = frontEdges(turn);
      expect(seen([0, back, -1], turn).behind).toBeLessThanOrEqual(seen([0, -back, -1], turn).behind);
      expect(seen([right, 0, -1], turn).behind).toBeLessThanOrEqual(seen([-right, 0, -1], turn).behind);
    }
  });
});

describe("painting", () => {
  it("begins with the farthest face and leaves none out", () => {
    const positions = [-1, 0, 1];
    const corners = positions.map((back) => positions.map((right) => seen([right, back, 0], FIRST_TURN)));
    const faces = facesFromBehind(corners);
    expect(faces).toHaveLength(4);
    expect(faces.every((face, i) => i === 0 || face.behind <= faces[i - 1]!.behind)).toBe(true);
    expect(new Set(faces.map((f) => `${f.row},${f.column}`)).size).toBe(4);
  });
});

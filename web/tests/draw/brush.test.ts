import { describe, expect, it } from "vitest";
import { SvgBrush } from "../../src/draw/brush";

describe("the SVG brush", () => {
  it("breaks a line where a point is missing", () => {
    const brush = new SvgBrush();
    brush.line([0, 1, NaN, 3, 4], [0, 1, 2, 3, 4], { colour: "red", dash: [4, 2] });
    const file = brush.file(10, 10, "white");
    expect(file).toContain('d="M0 0L1 1M3 3L4 4"');
    expect(file).toContain('stroke-dasharray="4 2"');
  });

  it("writes text that cannot leave its place", () => {
    const brush = new SvgBrush();
    brush.text(`</text><script>"'&`, { x_px: 1, y_px: 2 }, { colour: "red" });
    expect(brush.file(10, 10, "white")).not.toContain("<script>");
  });

  it("closes what it clips", () => {
    const brush = new SvgBrush();
    brush.clipped({ left: 0, top: 0, width: 5, height: 5 }, () =>
      brush.circle({ x_px: 1, y_px: 1 }, 2, { colour: "red" }),
    );
    const file = brush.file(10, 10, "white");
    expect(file.match(/<g /g)).toHaveLength(1);
    expect(file.match(/<\/g>/g)).toHaveLength(1);
  });
});

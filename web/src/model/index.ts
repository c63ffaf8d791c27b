/** The document a designer edits: models as values, edits, patches, history. */

export { checkCurve, checkModel, checkVibration } from "./check";
export {
  assignCurve,
  copyCurve,
  copySegment,
  copyStroke,
  moveCurve,
  removeCurve,
  type Segment,
  setVelocity,
} from "./curves";
export { applyEdit, type Edit, together } from "./edit";
export { addNote, type ModelNumber, renameModel, setInterpolation, setNumber, setProvenance } from "./facts";
export { History, type HistoryRecord, type Made, type Pin, type Step } from "./history";
export { CONFLICTS, type Conflict, type MergeOptions, merge, mergeModels } from "./merge";
export {
  canonical,
  curveAt,
  type FileModel,
  isAt,
  label,
  same,
  velocities_mm_s,
  vibrationAt,
} from "./model";
export {
  applyPatch,
  type CurveChange,
  diff,
  invert,
  isEmpty,
  type Patch,
  type VibrationChange,
} from "./patch";
export {
  addPoint,
  drawCurve,
  movePoints,
  type PointValues,
  refitCurve,
  removePoint,
  setPoints,
} from "./points";
export type { Answer, Change, DocumentServer, OpenedDocument, Surroundings } from "./server";
export { NUDGE_s, type When } from "./steps";
export { DocumentStore, type HistoryView, type SaveState } from "./store";
export type {
  CurveRef,
  CurveSpread,
  FDVVModel,
  ForceCurve,
  Mode,
  ModeSpread,
  PointSpread,
  PointsRef,
  Provenance,
  Vibration,
  VibrationSpread,
} from "./types";
export {
  addMode,
  addVibration,
  copyVibration,
  moveVibration,
  NEW_MODE,
  newVibration,
  removeMode,
  removeVibration,
  setDuration,
  setMode,
  setModes,
  setOnset,
} from "./vibrations";
export { scaleBase, scaleBump, scaleForce, stretchTravel, type Whose } from "./whole";

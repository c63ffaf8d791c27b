/**
 * Input reports of analog keyboards: which keys are how deep.
 *
 * Sources, read and not tried on a keyboard:
 * Wooting, github.com/WootingKb/wooting-analog-sdk, wooting-analog-sdk/src/device.rs: interface 1 (usage page
 * 0xFF54, 48 bytes) and interface 2 (0xFF53, 64 bytes);
 * Razer, github.com/calamity-inc/Soup, soup/AnalogueKeyboard.cpp: reports 7 and 11, sent while Razer's own
 * program runs.
 */

/** One key of a report. ratio: depth as a part of the keyboard's full scale, 0 to 1. */
export interface KeyDepth {
  readonly code: number;
  readonly ratio: number;
}

/** The keys that a report names, all others being up; or one line on why it says nothing. */
export type Parsed =
  | { readonly keys: readonly KeyDepth[]; readonly problem?: undefined }
  | { readonly keys?: undefined; readonly problem: string };

export interface DeviceFilter {
  readonly vendorId: number;
  readonly productId?: number;
  readonly usagePage?: number;
}

export interface ReportFormat {
  readonly name: string;
  readonly filters: readonly DeviceFilter[];
  /** Number of its reports; null where those of the usage page have any. */
  readonly reportId: number | null;
  /** Steps of the full scale. */
  readonly steps: number;
  /** Whether a code is a usage of HID's keyboard page (0x04: A), or the maker's own number. */
  readonly usages: boolean;
  readonly bytesPerKey: number;
  readonly keyOf: (bytes: DataView, at: number) => { readonly code: number; readonly value: number };
}

/** Codes are in sixteen groups of 256; a larger one is of something else. */
const MOST_CODES = 0x1000;
const WOOTING = 0x31e3;
const RAZER = 0x1532;

const interface1 = {
  reportId: null,
  usages: true,
  bytesPerKey: 3,
  keyOf: (bytes: DataView, at: number) => ({ code: bytes.getUint16(at), value: bytes.getUint8(at + 2) }),
} as const;

const razer = {
  steps: 255,
  usages: false,
  keyOf: (bytes: DataView, at: number) => ({ code: bytes.getUint8(at), value: bytes.getUint8(at + 1) }),
} as const;

export const FORMATS: readonly ReportFormat[] = [
  {
    name: "Wooting, interface 2",
    filters: [{ vendorId: WOOTING, usagePage: 0xff53 }],
    reportId: null,
    steps: 1023,
    usages: true,
    bytesPerKey: 4,
    keyOf: wooting2,
  },
  {
    name: "Wooting, interface 1",
    filters: [{ vendorId: WOOTING, usagePage: 0xff54 }],
    steps: 255,
    ...interface1,
  },
  {
    name: "Wooting One or Two, old firmware",
    filters: [0xff01, 0xff02].map((productId) => ({ vendorId: 0x03eb, productId, usagePage: 0xff54 })),
    // the key is down at five sixths of the byte
    steps: 255 / 1.2,
    ...interface1,
  },
  {
    name: "Razer Huntsman Analog",
    filters: [0x0266, 0x0282].map((productId) => ({ vendorId: RAZER, productId })),
    reportId: 7,
    bytesPerKey: 2,
    ...razer,
  },
  {
    name: "Razer Huntsman V3 Pro",
    filters: [0x02a6, 0x02a7, 0x02b0].map((productId) => ({ vendorId: RAZER, productId })),
    reportId: 11,
    bytesPerKey: 3,
    ...razer,
  },
];

/** Bytes: place in the matrix; code; two low bits of the depth, four high bits of the code, actuated; depth. */
function wooting2(bytes: DataView, at: number): { code: number; value: number } {
  const packed = bytes.getUint8(at + 2);
  return {
    code: (((packed >> 2) & 0xf) << 8) | bytes.getUint8(at + 1),
    value: (bytes.getUint8(at + 3) << 2) | (packed >> 6),
  };
}

/** Read a report, without its number. What is torn, empty or of something else is left out as a whole. */
export function parseReport(format: ReportFormat, bytes: DataView, reportId = 0): Parsed {
  const size = bytes.byteLength;
  if (format.reportId !== null && reportId !== format.reportId)
    return { problem: `a report of an unknown kind was left out (number ${reportId}, ${size} bytes)` };
  if (!size) return { problem: "an empty report was left out" };
  const depths = new Map<number, number>();
  let at = 0;
  for (; at + format.bytesPerKey <= size; at += format.bytesPerKey) {
    const { code, value } = format.keyOf(bytes, at);
    if (code >= MOST_CODES)
      return { problem: `a report of an unknown kind was left out (it names key ${code})` };
    // what follows the last key is zero; of a key that is named twice the last counts
    if (code) depths.set(code, Math.min(1, value / format.steps));
  }
  for (; at < size; at++)
    if (bytes.getUint8(at)) return { problem: `a torn report was left out (${size} bytes)` };
  return { keys: [...depths].map(([code, ratio]) => ({ code, ratio })) };
}

/** What of a device tells its format. */
export interface DeviceIdentity {
  readonly vendorId: number;
  readonly productId: number;
  readonly collections: readonly { readonly usagePage?: number }[];
}

/** Return the format of a device's reports, the finest if it has several; null if none is known. */
export function formatOf(device: DeviceIdentity): ReportFormat | null {
  return FORMATS.find(({ filters }) => filters.some((filter) => matches(device, filter))) ?? null;
}

function matches(device: DeviceIdentity, { vendorId, productId, usagePage }: DeviceFilter): boolean {
  return (
    device.vendorId === vendorId &&
    (productId === undefined || device.productId === productId) &&
    (usagePage === undefined || device.collections.some((one) => one.usagePage === usagePage))
  );
}

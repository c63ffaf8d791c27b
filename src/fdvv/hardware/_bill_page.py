"""The bill of materials as a page."""

from __future__ import annotations

from fdvv.hardware._bill import GROUPS, PAPER_USD, Bill, dates, group_totals

ABOUT = {
    "rig": "the rig: force, position, travel",
    "vibration": "vibration",
    "strip": "the pointing task's LED strip",
    "capture": "the capture bench, without cameras",
}


def bill_page(bill: Bill) -> str:
    """Write the bill as Markdown: a table per group, totals beside the paper's."""
    lines = [
        "# Bill of materials",
        "",
        "Made from `src/fdvv/hardware/bill.toml` and the circuit by `tools/make_circuit.py`; do not edit.",
        "",
    ]
    lines += [summary(bill), ""]
    for group in GROUPS:
        lines += [
            "",
            f"## {ABOUT[group].capitalize()}",
            "",
            "| what | part | count | USD | note, alternatives |",
            "|---|---|---|---|---|",
        ]
        for line in bill.of(group).lines:
            rest = "; ".join([*([line.note] if line.note else []), *(f"or {a}" for a in line.alternatives)])
            part = f"{line.maker} {line.part_number}"
            lines.append(f"| {line.role} | {part} | {line.count} | {line.total_USD:.2f} | {rest} |")
    return "\n".join([*lines, ""])


def summary(bill: Bill) -> str:
    """Tell the total in a sentence or two, beside the paper's."""
    totals = group_totals(bill)
    estimates = sum(line.estimated for line in bill.lines)
    built = totals["rig"] + totals["vibration"]
    return (
        f"{bill.total_USD:.0f} USD in all; rig and vibration, what the paper built for about "
        f"{PAPER_USD:.0f} USD, {built:.0f} USD. {estimates} of {len(bill.lines)} prices "
        f"are estimates of {dates(bill.lines)}, without shipping and tax."
    )

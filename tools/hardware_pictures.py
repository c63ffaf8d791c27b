"""The rig's pictures, drawn from the exported parts: assembled, cut, exploded, step by step, part by part."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from PIL import Image, ImageDraw
from tools.hardware_render import Camera, Colour, Thing, draw, font, save

from fdvv_rig.bought import bought_parts
from fdvv_rig.dimensions import Dimensions
from fdvv_rig.envelope import Block, Envelope, Rod
from fdvv_rig.manifest import read_manifest
from fdvv_rig.mesh import Mesh, read_stl
from fdvv_rig.parts import PARTS, part_named
from fdvv_rig.placement import RIG, Moves, Pose, State, in_rig, moved, on_jig
from fdvv_rig.solids import body_of, body_of_bought, mesh_of, placed

PRINTED: Colour = (0.36, 0.62, 0.86)
MOVING: Colour = (0.96, 0.64, 0.26)
STOPPING: Colour = (0.45, 0.76, 0.52)
DONE: Colour = (0.88, 0.89, 0.91)
BOUGHT: dict[str, Colour] = {
    "coil": (0.62, 0.64, 0.68),
    "lvdt": (0.72, 0.73, 0.76),
    "servo": (0.35, 0.40, 0.52),
    "horn": (0.93, 0.93, 0.95),
    "keycap": (0.30, 0.32, 0.36),
    "exciter": (0.55, 0.38, 0.30),
    "cell": (0.55, 0.38, 0.30),
    "bushing": (0.86, 0.76, 0.34),
    "coupling": (0.85, 0.70, 0.32),
    "core": (0.80, 0.62, 0.30),
    "main-board": (0.16, 0.44, 0.36),
    "driver-board": (0.55, 0.20, 0.26),
}
METAL: Colour = (0.78, 0.80, 0.83)
ADDED: Colour = (0.95, 0.80, 0.30)
COLOURS = {
    **dict.fromkeys(("slider-yoke", "keycap-adapter", "cell-holder"), MOVING),
    "cell-plate": (0.30, 0.32, 0.36),
    "limiter-arm": STOPPING,
}
APART_mm = {
    "base": (0, 0, -70),
    "main-board": (0, 0, -20),
    "driver-board": (0, 0, -20),
    "lvdt-mount": (0, 0, -34),
    "lvdt": (0, 0, 6),
    "core": (0, 0, 44),
    "coupling": (0, 0, 54),
    "coil-mount": (0, 0, 80),
    "bushing": (0, 0, 108),
    "coil": (0, 0, 116),
    "rod": (0, 0, 128),
    "slider-yoke": (0, 0, 142),
    "exciter": (0, -30, 160),
    "keycap-adapter": (0, 0, 160),
    "keycap": (0, 0, 172),
    "pin": (-26, 0, 80),
    "limiter-arm": (34, 0, 20),
    "horn": (46, 0, 20),
    "limiter-bracket": (62, 0, 0),
    "servo": (96, 0, 20),
    "mount-screws": (0, 0, -80),
    "tower-screws": (0, 0, 90),
    "clamp-screw": (-24, 0, 80),
    "grub": (0, 24, 142),
    "yoke-screws": (0, 0, 134),
    "bracket-screws": (62, 0, 14),
    "servo-screws": (114, 0, 20),
}
CELL_APART_mm = {
    "yoke-screws": -10.0,
    "slider-yoke": 0.0,
    "cell-holder": 10.0,
    "cell": 20.0,
    "cell-plate": 26.0,
}
STEPS = (
    ("1", ("base", "lvdt-mount", "mount-screws", "main-board", "driver-board")),
    ("2", ("coil-mount", "tower-screws", "bushing", "coil", "clamp-screw")),
    ("3", ("rod", "coupling", "core", "lvdt")),
    ("4", ("slider-yoke", "grub", "pin")),
    ("5", ("limiter-bracket", "bracket-screws", "servo", "servo-screws", "horn", "limiter-arm")),
    ("6", ("keycap-adapter", "yoke-screws", "exciter", "keycap")),
)


class Rig:
    """Exported and bought parts as meshes, placed in a state."""

    def __init__(self, folder: Path, cell: bool = False) -> None:
        """Read the exported parts; cell: of the recommended rig."""
        self.d: Dimensions = read_manifest(folder).made_from()
        self.printed = {p.name: read_stl(folder / "parts" / f"{p.name}.stl") for p in PARTS}
        self.bought = {envelope.name: envelope for envelope in bought_parts(self.d, cell)}

    def names(self) -> list[str]:
        """Return the parts of the rig without its box."""
        return [*(name for name in RIG if name != "black-box"), *self.bought]

    def mesh(self, name: str, state: State, cut: bool = False) -> Mesh:
        """Return a part where it stands, whole or what lies behind the plane y = 0."""
        if name in self.printed:
            body = placed(body_of(self.printed[name]), in_rig(name, state, self.d))
        else:
            envelope = self.bought[name]
            body = placed(body_of_bought(envelope), moved(envelope.moves, state, self.d))
        return mesh_of(body.trim_by_plane((0, 1, 0), 0.0) if cut else body)

    def label(self, name: str) -> str:
        """Return what a part is called."""
        return part_named(name).title if name in self.printed else self.bought[name].title

    def things(
        self, names: Iterable[str], state: State, label: bool = True, cut: bool = False
    ) -> list[Thing]:
        """Return parts to draw."""
        return [
            Thing(self.mesh(name, state, cut), colour(name), self.label(name) if label else "")
            for name in names
        ]


def colour(name: str) -> Colour:
    """Return a part's colour: printed ones by what they do, bought ones by what they are."""
    return COLOURS.get(name) or BOUGHT.get(name) or (PRINTED if name in RIG else METAL)


def draw_all(folder: Path) -> None:
    """Draw every picture into the folder's pictures/."""
    rig, out = Rig(folder), folder / "pictures"
    rest = State(0.0)
    save(draw(rig.things(rig.names(), rest), Camera(), (1000, 860)), out / "assembled.png")
    save(draw(rig.things(rig.names(), rest, cut=True), Camera(8, 6), (1000, 860)), out / "section.png")
    save(draw(_exploded(rig), Camera(24, 22), (1000, 1240)), out / "exploded.png")
    save(_limiter(rig), out / "limiter.png")
    save(_cell_cap(folder), out / "cell-cap.png")
    save(_steps(rig), out / "steps.png")
    save(draw(_jig(rig), Camera(28, 34), (900, 620)), out / "capture-jig.png")
    save(draw(_boxed(rig), Camera(24, 18), (860, 820)), out / "black-box.png")
    for part in PARTS:
        thing = Thing(rig.printed[part.name], colour(part.name))
        save(draw([thing], Camera(30, 32), (360, 300)), out / f"part-{part.name}.png", 64)


def _exploded(rig: Rig) -> list[Thing]:
    made = []
    for thing, name in zip(rig.things(rig.names(), State(0.0)), rig.names(), strict=True):
        shift = Pose(shift_mm=tuple(float(v) for v in APART_mm[name]))  # type: ignore[arg-type]
        made.append(Thing(thing.mesh.moved(shift), thing.colour, thing.label))
    return made


def _cell_cap(folder: Path) -> Image.Image:
    """Draw the cap with the load cell: its parts apart, and cut along the axis."""
    rig = Rig(folder, cell=True)
    names = ("slider-yoke", "yoke-screws", "cell-holder", "cell", "cell-plate")
    apart = []
    for thing, name in zip(rig.things(names, State(0.0)), names, strict=True):
        shift = Pose(shift_mm=(0.0, 0.0, CELL_APART_mm[name]))
        apart.append(Thing(thing.mesh.moved(shift), thing.colour, thing.label))
    cut = rig.things(names, State(0.0), cut=True)
    return _row([draw(apart, Camera(28, 30), (520, 560)), draw(cut, Camera(8, 10), (520, 560))])


def _limiter(rig: Rig) -> Image.Image:
    """Draw the slider down on the limiter at three settings, seen from the tower."""
    names = ("slider-yoke", "limiter-arm", "keycap-adapter", "servo", "limiter-bracket")
    made = []
    for travel_mm in (0.0, rig.d.travel_mm / 2, rig.d.travel_mm):
        state = State(travel_mm, travel_mm)
        angle = state.angle_deg(rig.d)
        picture = draw(rig.things(names, state, label=False), Camera(-72, 6), (320, 470))
        made.append(_titled(picture, f"stop at {travel_mm:g} mm: {angle:.0f}°"))
    return _row(made)


def _steps(rig: Rig) -> Image.Image:
    """Draw the rig after each step of its assembly; what is new has its colour."""
    made, there = [], []
    everything = rig.names()
    for number, new in STEPS:
        there += list(new)
        things = [
            Thing(rig.mesh(name, State(0.0)), _fresh(name) if name in new else DONE)
            for name in everything
            if name in there
        ]
        made.append(_titled(draw(things, Camera(-30 if number == "4" else 32, 26), (330, 340)), number))
    rows = [_row(made[:3]), _row(made[3:])]
    sheet = Image.new("RGB", (rows[0].width, rows[0].height + rows[1].height), "white")
    sheet.paste(rows[0], (0, 0))
    sheet.paste(rows[1], (0, rows[0].height))
    return sheet


def _fresh(name: str) -> Colour:
    """Return the colour of a part that a step adds: bought ones stand out from what is there already."""
    return colour(name) if name in COLOURS or name in RIG else ADDED


def _titled(image: Image.Image, title: str) -> Image.Image:
    ImageDraw.Draw(image).text((10, 6), title, fill=(20, 33, 61), font=font(17))
    return image


def _row(images: list[Image.Image]) -> Image.Image:
    sheet = Image.new("RGB", (sum(i.width for i in images), max(i.height for i in images)), "white")
    x = 0
    for image in images:
        sheet.paste(image, (x, 0))
        x += image.width
    return sheet


def _jig(rig: Rig) -> list[Thing]:
    """Return the jig with its posts and markers, a switch and its keycap."""
    d = rig.d
    made = [Thing(rig.printed["capture-jig"].moved(on_jig("capture-jig", d)[0]), PRINTED, "Capture jig")]
    for i, pose in enumerate(on_jig("marker-post", d)):
        post = rig.printed["marker-post"].moved(pose)
        made.append(Thing(post, MOVING, "" if i else "Marker post"))
        x, y = post.points[:, :2].mean(axis=0)
        ball = mesh_of(
            _ball(d.marker_diameter_mm).translate((x, y, d.post_height_mm + d.marker_diameter_mm / 4))
        )
        made.append(Thing(ball, (0.85, 0.86, 0.88), "" if i else "reference marker"))
    switch = Envelope("switch", "", Moves.FIXED, (Block((-6.9, -6.9, -8.0), (6.9, 6.9, 6.0)),))
    rim = Envelope("rim", "", Moves.FIXED, (Block((-7.8, -7.8, 0.0), (7.8, 7.8, 1.0)),))
    cap = Envelope("cap", "", Moves.FIXED, (Block((-9.1, -9.1, 7.5), (9.1, 9.1, 17.0)),))
    for envelope, name, tint in (
        (switch, "", METAL),
        (rim, "MX switch", METAL),
        (cap, "keycap", BOUGHT["keycap"]),
    ):
        made.append(Thing(mesh_of(body_of_bought(envelope)), tint, name))
    for side in (-1, 1):
        ball = mesh_of(_ball(d.marker_diameter_mm).translate((side * (9.1 + 2.2), 0, 12)))
        made.append(Thing(ball, (0.85, 0.86, 0.88), "" if side > 0 else "marker on the cap"))
    for x in (-12.0, 0.0, 12.0):
        light = Envelope("led", "", Moves.FIXED, (Rod("y", (x, -27.5, -12.0), 6.0, d.led_diameter_mm),))
        made.append(
            Thing(
                mesh_of(body_of_bought(light)), (0.75, 0.30, 0.35), "" if x else "lights of the clapperboard"
            )
        )
    return made


def _ball(diameter_mm: float):  # type: ignore[no-untyped-def] # the library has no types
    import manifold3d

    return manifold3d.Manifold.sphere(diameter_mm / 2, 32)


def _boxed(rig: Rig) -> list[Thing]:
    """Return the rig inside the black box, of which only the edges show."""
    made = rig.things(rig.names(), State(0.0), label=False)
    return [*made, Thing(rig.mesh("black-box", State(0.0)), (0.2, 0.2, 0.2), ghost=True)]

"""Messages as records: what a payload means, and which bytes a record is."""

from __future__ import annotations

import zlib

from fdvv.errors import ModelError
from fdvv.protocol.frame import Frame
from fdvv.protocol.record import Record
from fdvv.protocol.tables import (
    DATA_BYTES,
    AnnounceRequest,
    BeginRequest,
    BoardLimits,
    CellSpec,
    ClearFaultRequest,
    DataReply,
    DataRequest,
    EventRequest,
    FaultedRequest,
    ForceLoopGains,
    HelloReply,
    HelloRequest,
    ImageHeader,
    KeyRequest,
    Message,
    PingReply,
    PingRequest,
    ReadCoilReply,
    ReadCountersReply,
    ReadFaultReply,
    ReadForceLoopReply,
    ReadForceLoopRequest,
    RecordsRequest,
    RefusedReply,
    SelftestReply,
    Settings,
    TelemetryRequest,
    TickRecord,
    VibrateRequest,
)

REPLY = 0x80
"""What a reply's number has more than its request's."""
REQUESTS: dict[Message, type[Record]] = {
    Message.HELLO: HelloRequest,
    Message.PING: PingRequest,
    Message.WRITE_SETTINGS: Settings,
    Message.BEGIN: BeginRequest,
    Message.DATA: DataRequest,
    Message.EVENT: EventRequest,
    Message.TELEMETRY: TelemetryRequest,
    Message.CLEAR_FAULT: ClearFaultRequest,
    Message.ANNOUNCE: AnnounceRequest,
    Message.VIBRATE: VibrateRequest,
    Message.READ_FORCE_LOOP: ReadForceLoopRequest,
    Message.WRITE_LOAD_CELL: CellSpec,
    Message.CLOSE_FORCE_LOOP: ForceLoopGains,
    Message.RECORDS: RecordsRequest,
    Message.FAULTED: FaultedRequest,
    Message.KEY: KeyRequest,
}
"""Structure of a request, or of what the device sends unasked; absent: it has no payload."""
REPLIES: dict[Message, type[Record]] = {
    Message.HELLO: HelloReply,
    Message.PING: PingReply,
    Message.READ_SETTINGS: Settings,
    Message.READ_LIMITS: BoardLimits,
    Message.READ_COIL: ReadCoilReply,
    Message.DATA: DataReply,
    Message.READ_FAULT: ReadFaultReply,
    Message.SELFTEST: SelftestReply,
    Message.READ_COUNTERS: ReadCountersReply,
    Message.READ_FORCE_LOOP: ReadForceLoopReply,
    Message.REFUSED: RefusedReply,
}
"""Structure of a reply; absent: it has no payload."""
_NOTICES = (Message.RECORDS, Message.FAULTED, Message.KEY)
UM16_PER_mm = 16_000
"""Counts of displacement: um16."""
CN64_PER_cN = 64
"""Counts of force: cN64."""
MM_S16_PER_mm_s = 16
"""Counts of velocity: mm_s16."""
CHECKED_FROM = 8
"""The checksum covers what follows magic and checksum."""


def request_frame(message: Message, sequence: int, body: Record | None = None) -> Frame:
    """Make the frame of a request. ModelError if the body is not the message's structure."""
    expected = REQUESTS.get(message)
    if type(body) is not (expected or type(None)):
        named = expected.__name__ if expected else "no body"
        raise ModelError(f"{message.name.lower()} takes {named}, got {type(body).__name__}")
    payload = b"" if body is None else body.pack()
    # of a data message only the bytes that are there are sent
    return Frame(message, sequence, payload[: 4 + body.count] if isinstance(body, DataRequest) else payload)


def data_request(offset: int, piece: bytes) -> DataRequest:
    """Return the message that carries a piece of an image."""
    return DataRequest(offset=offset, count=len(piece), bytes=piece.ljust(DATA_BYTES, b"\0"))


def read_reply(frame: Frame) -> tuple[Message, Record | None]:
    """Return a reply's message and body. ModelError if it is no reply, or has another length."""
    if not REPLY <= frame.message < Message.RECORDS and frame.message != Message.REFUSED + REPLY:
        raise ModelError(f"message {frame.message:#04x} is no reply")
    try:
        message = Message(frame.message - REPLY)
    except ValueError:
        raise ModelError(f"message {frame.message:#04x} is unknown") from None
    kind = REPLIES.get(message)
    if kind is None and frame.payload:
        raise ModelError(f"a message without payload has {len(frame.payload)} bytes")
    return message, kind.unpack(frame.payload) if kind else None


def read_notice(frame: Frame) -> tuple[RecordsRequest | FaultedRequest | KeyRequest, bytes]:
    """Read what a device sends unasked; of telemetry also the bytes of its records, else b"". ModelError."""
    kind = REQUESTS.get(Message(frame.message)) if frame.message in _NOTICES else None
    if kind is None:
        raise ModelError(f"message {frame.message:#04x} is no notice")
    size = kind.length_bytes()
    body, rest = kind.unpack(frame.payload[:size]), frame.payload[size:]
    assert isinstance(body, RecordsRequest | FaultedRequest | KeyRequest)
    count = body.count if isinstance(body, RecordsRequest) else 0
    if len(rest) != count * TickRecord.length_bytes():
        raise ModelError(f"telemetry of {count} records has {len(rest)} bytes of them")
    return body, rest


def head_of(image: bytes) -> ImageHeader:
    """Read the header of an image; ModelError if it is shorter or its fields are out of range."""
    return ImageHeader.unpack(image[: ImageHeader.length_bytes()])


def travel_mm_of(image: bytes) -> float:
    """Return where a program's bottom stop is set; ModelError as head_of."""
    return head_of(image).travel_um16 / UM16_PER_mm


def checksum_of(image: bytes) -> int:
    """Compute the checksum that an image should carry."""
    return zlib.crc32(image[CHECKED_FROM:])


def seal(image: bytes) -> bytes:
    """Put the checksum of an image in its place."""
    return image[:4] + checksum_of(image).to_bytes(4, "little") + image[CHECKED_FROM:]

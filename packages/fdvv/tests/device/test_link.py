"""The firmware's end of the link, asked frame by frame."""

from __future__ import annotations

import ctypes
import struct
import zlib
from itertools import pairwise

import pytest

from fdvv import _native
from fdvv.device.remote import surface_image
from fdvv.protocol.frame import Frame, encode
from fdvv.protocol.messages import data_request, read_notice, request_frame
from fdvv.protocol.tables import (
    DATA_BYTES,
    HASH,
    IMAGE_BYTES,
    REQUEST_BYTES,
    VERSION,
    AnnounceRequest,
    BeginRequest,
    ClearFaultRequest,
    EventRequest,
    Fault,
    FaultedRequest,
    HelloReply,
    HelloRequest,
    Message,
    Mode,
    PingReply,
    PingRequest,
    ReadCountersReply,
    ReadFaultReply,
    RecordsRequest,
    Refusal,
    RefusedReply,
    Settings,
    TelemetryRequest,
    VibrateRequest,
)
from fdvv.testing.conformance import plain_surface
from tests.support.link_rigs import LONG, PROGRAMS, Bench

IMAGE, OTHER = PROGRAMS


def refusal(frame: Frame) -> Refusal:
    """Return the reason of a refusal."""
    assert frame.message == Message.REFUSED + 0x80, frame
    return Refusal(RefusedReply.unpack(frame.payload).refusal)


def begin(bench: Bench, image: bytes, crc32: int | None = None) -> Frame:
    checksum = int.from_bytes(image[4:8], "little") if crc32 is None else crc32
    return bench.ask(Message.BEGIN, BeginRequest(size_bytes=len(image), crc32=checksum))


def send_data(bench: Bench, image: bytes, end: int | None = None) -> None:
    for offset in range(0, len(image) if end is None else end, DATA_BYTES):
        reply = bench.ask(Message.DATA, data_request(offset, image[offset : offset + DATA_BYTES]))
        assert reply.message == Message.DATA + 0x80


def upload(bench: Bench, image: bytes = IMAGE) -> None:
    begin(bench, image)
    send_data(bench, image)
    for message in (Message.COMMIT, Message.ACTIVATE):
        assert bench.ask(message, ticks=40).message == message + 0x80


def heads_of(frames: list[Frame]) -> list[RecordsRequest]:
    """Return the heads of telemetry frames."""
    found = [read_notice(f)[0] for f in frames if f.message == Message.RECORDS]
    return [head for head in found if isinstance(head, RecordsRequest)]


@pytest.fixture
def bench() -> Bench:
    found = Bench()
    found.run(2)
    return found


@pytest.fixture
def known(bench: Bench) -> Bench:
    bench.hello()
    return bench


def test_before_hello_only_hello_and_ping_are_answered(bench: Bench) -> None:
    for message in (Message.READ_SETTINGS, Message.ARM, Message.DISARM, Message.COMMIT):
        assert refusal(bench.ask(message)) is Refusal.WRONG_ORDER
    assert PingReply.unpack(bench.ask(Message.PING, PingRequest(host_us=5)).payload).host_us == 5


def test_another_hash_is_reported_and_blocks_everything_but_ping(bench: Bench) -> None:
    reply = bench.ask(Message.HELLO, HelloRequest(version=VERSION, hash=HASH ^ 1))
    assert HelloReply.unpack(reply.payload).hash == HASH
    assert refusal(bench.ask(Message.READ_SETTINGS)) is Refusal.HASH_MISMATCH
    assert bench.ask(Message.PING, PingRequest(host_us=1)).message == Message.PING + 0x80


def test_another_version_is_as_bad_as_another_hash(bench: Bench) -> None:
    bench.ask(Message.HELLO, HelloRequest(version=VERSION + 1, hash=HASH))
    assert refusal(bench.ask(Message.ARM)) is Refusal.HASH_MISMATCH


def test_the_device_tells_who_it_is(bench: Bench) -> None:
    hello = HelloReply.unpack(bench.hello().payload)
    assert (hello.image_bytes, hello.tick_us, hello.mode) == (IMAGE_BYTES, 250, Mode.IDLE)
    assert hello.name.rstrip(b"\0") == b"host"


def test_a_repeated_request_gets_the_same_answer_and_is_not_carried_out_again(known: Bench) -> None:
    upload(known)
    begin(known, OTHER)
    data = encode(request_frame(Message.DATA, 77, data_request(0, OTHER[:64])))
    first = known.send(data)
    assert known.send(data) == first
    # were it carried out again, it would still be accepted; telemetry shows that nothing ran twice
    again = encode(request_frame(Message.ANNOUNCE, 78, AnnounceRequest(velocity_mm_s16=1600)))
    assert [f.sequence for f in known.send(again) + known.send(again)] == [78, 78]


def test_a_repeated_activate_does_not_flip_the_banks_back(known: Bench) -> None:
    upload(known, IMAGE)
    begin(known, OTHER)
    send_data(known, OTHER)
    known.ask(Message.COMMIT, ticks=40)
    request = encode(request_frame(Message.ACTIVATE, 200))
    answers = known.send(request) + known.send(request)
    assert [a.message for a in answers] == [Message.ACTIVATE + 0x80] * 2
    assert known.board.program() == OTHER


def test_the_same_sequence_with_other_bytes_is_another_request(known: Bench) -> None:
    for value in (1600, 3200):
        body = AnnounceRequest(velocity_mm_s16=value)
        assert known.send(encode(request_frame(Message.ANNOUNCE, 9, body)))[0].message == 0x91
    assert refusal(known.send(encode(request_frame(Message.ARM, 9)))[0]) is Refusal.NO_IMAGE


@pytest.mark.parametrize("message", [m for m in Message if m < Message.REFUSED], ids=lambda m: m.name)
def test_a_request_of_another_length_is_refused(known: Bench, message: Message) -> None:
    payload = bytes(REQUEST_BYTES[message] + 1)
    reply = known.send(encode(Frame(message, 3, payload)), 20)[0]
    assert refusal(reply) is Refusal.BAD_LENGTH
    assert RefusedReply.unpack(reply.payload).detail == len(payload)


@pytest.mark.parametrize("number", [0, 0x19, 0x7E, 0x7F, 0x80, 0xC0, 0xFF])
def test_an_unknown_request_is_refused_by_its_number(known: Bench, number: int) -> None:
    reply = known.send(encode(Frame(number, 3)))[0]
    assert refusal(reply) is Refusal.UNKNOWN_MESSAGE
    assert RefusedReply.unpack(reply.payload).request == number


def test_a_whole_upload_becomes_the_program(known: Bench) -> None:
    assert refusal(known.ask(Message.ARM)) is Refusal.NO_IMAGE
    upload(known)
    assert known.board.program() == IMAGE
    assert known.ask(Message.ARM).message == Message.ARM + 0x80
    assert known.run(4) == []
    assert known.port.outputs.duty_q15 > 0


def test_data_comes_in_order_or_not_at_all(known: Bench) -> None:
    assert refusal(known.ask(Message.DATA, data_request(0, b"abcd"))) is Refusal.WRONG_ORDER
    begin(known, IMAGE)
    assert refusal(known.ask(Message.DATA, data_request(4, IMAGE[4:8]))) is Refusal.WRONG_ORDER
    send_data(known, IMAGE[:DATA_BYTES])
    assert known.ask(Message.DATA, data_request(8, IMAGE[8:16])).message == Message.DATA + 0x80
    assert refusal(known.ask(Message.DATA, data_request(8, b"x" * 8))) is Refusal.BAD_VALUE
    assert refusal(known.ask(Message.DATA, data_request(8, IMAGE[8 : 8 + DATA_BYTES]))) is Refusal.WRONG_ORDER


def test_commit_wants_all_bytes_and_activate_a_commit(known: Bench) -> None:
    assert refusal(known.ask(Message.COMMIT)) is Refusal.WRONG_ORDER
    assert refusal(known.ask(Message.ACTIVATE)) is Refusal.WRONG_ORDER
    begin(known, IMAGE)
    send_data(known, IMAGE, DATA_BYTES)
    assert refusal(known.ask(Message.COMMIT)) is Refusal.WRONG_ORDER
    assert refusal(known.ask(Message.ACTIVATE)) is Refusal.WRONG_ORDER


def test_more_data_than_announced_is_refused(known: Bench) -> None:
    begin(known, IMAGE[:64])
    assert refusal(known.ask(Message.DATA, data_request(0, IMAGE[:68]))) is Refusal.TOO_LARGE


@pytest.mark.parametrize(
    ("size", "why"),
    [(0, Refusal.BAD_VALUE), (28, Refusal.BAD_VALUE), (402, Refusal.BAD_VALUE), (7172, Refusal.TOO_LARGE)],
)
def test_a_size_that_no_program_has_is_refused(known: Bench, size: int, why: Refusal) -> None:
    assert refusal(known.ask(Message.BEGIN, BeginRequest(size_bytes=size, crc32=0))) is why


def test_a_damaged_program_is_refused_and_the_old_one_stays(known: Bench) -> None:
    upload(known)
    begin(known, OTHER)
    send_data(known, OTHER[:-4] + b"\1\2\3\4")
    assert refusal(known.ask(Message.COMMIT, ticks=40)) is Refusal.CHECKSUM
    assert refusal(known.ask(Message.ACTIVATE)) is Refusal.WRONG_ORDER
    assert known.board.program() == IMAGE


def test_a_program_beyond_the_force_limit_is_refused(known: Bench) -> None:
    data = bytearray(IMAGE)
    data[-2:] = struct.pack("<h", 28161)
    data[4:8] = struct.pack("<I", zlib.crc32(data[8:]))
    begin(known, bytes(data))
    send_data(known, bytes(data))
    assert refusal(known.ask(Message.COMMIT, ticks=40)) is Refusal.IMAGE_RANGE


def test_a_new_begin_forgets_a_checked_program(known: Bench) -> None:
    begin(known, IMAGE)
    send_data(known, IMAGE)
    known.ask(Message.COMMIT, ticks=40)
    begin(known, OTHER)
    assert refusal(known.ask(Message.ACTIVATE)) is Refusal.WRONG_ORDER


def test_while_a_check_runs_the_host_may_ping_and_stop_but_nothing_else(known: Bench) -> None:
    begin(known, LONG)
    send_data(known, LONG)
    ask = [
        request_frame(Message.COMMIT, 50),
        request_frame(Message.COMMIT, 50),
        request_frame(Message.BEGIN, 51, BeginRequest(size_bytes=64, crc32=0)),
        request_frame(Message.PING, 52, PingRequest(host_us=1)),
        request_frame(Message.DISARM, 53),
    ]
    found = known.send(b"".join(map(encode, ask)), 60)
    assert sorted(f.sequence for f in found) == [50, 51, 52, 53]
    answers = {f.sequence: f for f in found}
    assert refusal(answers.pop(51)) is Refusal.BUSY
    messages = {sequence: frame.message - 0x80 for sequence, frame in answers.items()}
    assert messages == {50: Message.COMMIT, 52: Message.PING, 53: Message.DISARM}


def test_settings_are_written_whole_while_idle_and_forget_the_program(known: Bench) -> None:
    upload(known)
    settings = Settings(force_limit_cN64=6400)
    assert known.ask(Message.WRITE_SETTINGS, settings).message == Message.WRITE_SETTINGS + 0x80
    assert Settings.unpack(known.ask(Message.READ_SETTINGS).payload) == settings
    assert known.board.program() is None
    assert refusal(known.ask(Message.ARM)) is Refusal.NO_IMAGE


def test_a_program_whose_stop_lies_beyond_the_board_s_is_refused(known: Bench) -> None:
    deepest_mm = HelloReply.unpack(known.hello().payload).travel_um16_256 * 256 / 16000
    upload(known, surface_image(plain_surface(20.0, 4.0), deepest_mm))
    image = surface_image(plain_surface(20.0, 4.0), deepest_mm + 0.01)
    begin(known, image)
    send_data(known, image)
    assert refusal(known.ask(Message.COMMIT, ticks=40)) is Refusal.IMAGE_RANGE


def test_settings_out_of_range_change_nothing(known: Bench) -> None:
    data = bytearray(Settings().pack())
    data[24:26] = struct.pack("<H", 50)  # tick_us
    reply = known.send(encode(Frame(Message.WRITE_SETTINGS, 4, bytes(data))))[0]
    assert refusal(reply) is Refusal.BAD_VALUE
    assert Settings.unpack(known.ask(Message.READ_SETTINGS).payload) == Settings()


def test_settings_are_refused_while_armed(known: Bench) -> None:
    upload(known)
    known.ask(Message.ARM)
    assert refusal(known.ask(Message.WRITE_SETTINGS, Settings())) is Refusal.WRONG_MODE


def test_settings_that_hold_the_device_in_a_fault_can_be_replaced(known: Bench) -> None:
    known.ask(Message.WRITE_SETTINGS, Settings(reading_low=4000))
    known.run(10)
    reply = ReadFaultReply.unpack(known.ask(Message.READ_FAULT).payload)
    assert reply.fault == Fault.POSITION_LOW
    known.ask(Message.WRITE_SETTINGS, Settings())
    known.run(10)
    known.ask(Message.CLEAR_FAULT, ClearFaultRequest(fault=reply.fault))
    assert ReadFaultReply.unpack(known.ask(Message.READ_FAULT).payload).fault == Fault.NONE


def test_telemetry_comes_without_gaps_at_the_asked_distance(known: Bench) -> None:
    for every in (1, 2, 5, 16, 100):
        known.ask(Message.TELEMETRY, TelemetryRequest(every=every))
        heads = heads_of(known.run(400))
        ticks = [h.first_tick + every * i for h in heads for i in range(h.count)]
        assert len(ticks) >= 400 // every - 16
        assert {b - a for a, b in pairwise(ticks)} == {every}
        assert all(h.first_us == 250 * h.first_tick for h in heads)
        known.ask(Message.TELEMETRY, TelemetryRequest(every=0))
        assert known.run(100) == []


def test_telemetry_for_which_there_is_no_room_is_counted(known: Bench) -> None:
    known.ask(Message.TELEMETRY, TelemetryRequest(every=1))
    for _ in range(400):
        known.port.step()  # nobody reads
    heads = heads_of(known.run(100))
    received = sum(h.count for h in heads)
    last = heads[-1]
    assert last.lost > 300
    assert received + last.lost == last.first_tick + last.count - heads[0].first_tick
    known.ask(Message.TELEMETRY, TelemetryRequest(every=0))
    counters = ReadCountersReply.unpack(known.ask(Message.READ_COUNTERS).payload)
    assert counters.lost_records >= last.lost


def test_a_reply_finds_room_although_nobody_reads_telemetry(known: Bench) -> None:
    known.ask(Message.TELEMETRY, TelemetryRequest(every=1))
    known.port.write(encode(request_frame(Message.PING, 99, PingRequest(host_us=4))))
    for _ in range(400):
        known.port.step()
    assert [f.sequence for f in known.run(1) if f.message == Message.PING + 0x80] == [99]


def test_a_missed_tick_is_a_gap_and_no_record(known: Bench) -> None:
    known.ask(Message.TELEMETRY, TelemetryRequest(every=1))
    found = known.run(10)
    plant = known.person.rest(Settings())
    plant.meddle = lambda _tick, inputs: inputs._replace(elapsed_ticks=3)
    known.port.connect(plant)
    found += known.run(1)
    known.port.connect(known.person.rest(Settings()))
    found += known.run(40)
    heads = heads_of(found)
    jumps = [b.first_tick - a.first_tick - a.count for a, b in pairwise(heads)]
    assert sorted(set(jumps)) == [0, 2]
    assert heads[-1].late == 2


def test_readings_that_come_twice_in_a_tick_do_not_count_as_late(known: Bench) -> None:
    known.ask(Message.TELEMETRY, TelemetryRequest(every=1))
    plant = known.person.rest(Settings())
    plant.meddle = lambda _tick, inputs: inputs._replace(elapsed_ticks=0)
    known.port.connect(plant)
    known.run(1)
    known.port.connect(known.person.rest(Settings()))
    assert heads_of(known.run(40))[-1].late == 0


def test_a_fault_is_reported_at_once_with_its_evidence(known: Bench) -> None:
    upload(known)
    known.ask(Message.ARM)
    plant = known.person.rest(Settings())
    plant.meddle = lambda _tick, inputs: inputs._replace(lowest=3)
    known.port.connect(plant)
    found = known.run(3)
    assert known.port.outputs.duty_q15 == 0
    assert [f.message for f in found] == [Message.FAULTED]
    notice, _ = read_notice(found[0])
    assert isinstance(notice, FaultedRequest)
    assert notice.fault == Fault.POSITION_LOW
    reply = ReadFaultReply.unpack(known.ask(Message.READ_FAULT).payload)
    assert (reply.fault, reply.value, reply.bound) == (Fault.POSITION_LOW, 3, 20)
    assert refusal(known.ask(Message.ARM)) is Refusal.FAULT_LATCHED
    known.port.connect(known.person.rest(Settings()))
    known.run(20)
    assert known.ask(Message.CLEAR_FAULT, ClearFaultRequest(fault=reply.fault)).message == 0x8E
    assert PingReply.unpack(known.ask(Message.PING, PingRequest(host_us=0)).payload).mode == Mode.IDLE


def test_a_program_that_memory_corrupts_ends_force(known: Bench) -> None:
    upload(known, LONG)
    known.ask(Message.ARM)
    found = _native.library().fdvv_host_program(known.board._handle)
    ctypes.memset(found + 3000, 0x55, 1)
    # 64 bytes in every second piece of work, 8 pieces a tick, from anywhere in the program
    frames = known.run(2 * len(LONG) // (4 * 64))
    assert known.port.outputs.duty_q15 == 0
    notice, _ = read_notice(frames[-1])
    assert isinstance(notice, FaultedRequest)
    assert notice.fault == Fault.IMAGE_CORRUPT
    assert known.board.program() is None
    known.ask(Message.CLEAR_FAULT, ClearFaultRequest(fault=notice.fault))
    assert refusal(known.ask(Message.ARM)) is Refusal.NO_IMAGE


def test_memory_is_watched_although_nobody_reads_what_the_device_says(known: Bench) -> None:
    upload(known)
    known.ask(Message.ARM)
    known.ask(Message.TELEMETRY, TelemetryRequest(every=1))
    for number in range(8):
        known.port.write(encode(request_frame(Message.READ_SETTINGS, number)))
        for _ in range(20):
            known.port.step()
    assert known.port.outputs.duty_q15 > 0
    found = _native.library().fdvv_host_program(known.board._handle)
    ctypes.memset(found + 200, 0x55, 1)
    for _ in range(8):
        known.port.step()
    assert known.port.outputs.mode == Mode.FAULT


def test_silence_of_the_host_ends_rendering(known: Bench) -> None:
    upload(known)
    known.ask(Message.ARM)
    known.run(900)
    assert known.port.outputs.duty_q15 > 0
    known.run(108)
    assert known.port.outputs.duty_q15 == 0
    reply = ReadFaultReply.unpack(known.ask(Message.READ_FAULT).payload)
    assert reply.fault == Fault.HOST_LOST


def test_numbers_out_of_range_are_refused(known: Bench) -> None:
    bad = [
        Frame(Message.EVENT, 1, b"\x20\0"),
        Frame(Message.EVENT, 2, b"\x01\1"),
        Frame(Message.ANNOUNCE, 3, b"\x07\0\0\0"),
        Frame(Message.TELEMETRY, 4, b"\x01\1"),
    ]
    assert {refusal(known.send(encode(frame))[0]) for frame in bad} == {Refusal.BAD_VALUE}
    assert known.ask(Message.EVENT, EventRequest(event=31)).message == Message.EVENT + 0x80


def test_a_waveform_that_the_program_lacks_is_refused(known: Bench) -> None:
    assert refusal(known.ask(Message.VIBRATE, VibrateRequest(slot=0))) is Refusal.NO_IMAGE
    upload(known)
    assert refusal(known.ask(Message.VIBRATE, VibrateRequest(slot=0))) is Refusal.BAD_VALUE


def test_a_pulled_cable_forgets_the_host_and_the_upload_but_not_the_program(known: Bench) -> None:
    upload(known)
    begin(known, OTHER)
    send_data(known, OTHER)
    known.ask(Message.COMMIT, ticks=40)
    known.board.unplug()
    known.board.plug()
    assert refusal(known.ask(Message.ACTIVATE)) is Refusal.WRONG_ORDER
    known.hello()
    assert refusal(known.ask(Message.ACTIVATE)) is Refusal.WRONG_ORDER
    assert known.board.program() == IMAGE


def test_damaged_frames_are_counted(known: Bench) -> None:
    known.send(b"\x05abcd\0\x03\0" + b"x" * 300 + b"\0")
    counters = ReadCountersReply.unpack(known.ask(Message.READ_COUNTERS).payload)
    assert counters.bad_frames == 3

"""Recordings that are cut, flipped and overwritten at random, and what may come of it."""

import random
import time
from dataclasses import dataclass, field

from agent_server.errors import RecordingError
from agent_server.recording.reader import open_recording
from agent_server.recording.recover import recover

SLOW_S = 20.0
"""Processor time, far more than any of these files takes."""


@dataclass
class Damage:
    """What came of it.

    Attributes:
        files: Files that were damaged.
        damaged_bytes: Bytes of all these files.
        refused: Files that were not read to the end, with a sentence.
        unsaved: Files of which nothing could be saved, with a sentence.
        complete: Files of which the report says that nothing was lost.
        saved_records: Records saved of all files.
        lost_records: Records of all files that are not.
        slowest_s: The longest that reading and recovering a file has taken.
        faults: What must never come, in words.
    """

    files: int = 0
    damaged_bytes: int = 0
    refused: int = 0
    unsaved: int = 0
    complete: int = 0
    saved_records: int = 0
    lost_records: int = 0
    slowest_s: float = 0.0
    faults: list = field(default_factory=list)


class Trial:
    """Damages copies of a recording, and reads and recovers each.

    Args:
        whole: A recording in which nothing is wrong.
        folder: For the copies.
        seed: Of what is done to them.
    """

    def __init__(self, whole, folder, seed):
        self._whole = whole.read_bytes()
        self._records = list(open_recording(whole))
        self._by_sequence = {record.sequence: record for record in self._records}
        self._folder = folder
        self._random = random.Random(seed)
        self.damage = Damage()

    def cut_or_flip(self):
        """Cut the file somewhere, or flip some bits of it."""
        data = bytearray(self._whole)
        if self._random.random() < 0.5:
            del data[self._random.randrange(len(data)) :]
        else:
            for _ in range(self._random.choice((1, 1, 1, 2, 8))):
                data[self._random.randrange(len(data))] ^= 1 << self._random.randrange(8)
        self._try(bytes(data), is_strict=True)

    def mutate(self):
        """Do anything to it: also insert, repeat, leave out, and write far too large numbers."""
        data = bytearray(self._whole)
        for _ in range(self._random.choice((1, 2, 4, 16))):
            at, size = self._random.randrange(len(data) or 1), self._random.choice((1, 4, 8, 100))
            match self._random.randrange(7):
                case 0:
                    data[at : at + size] = self._random.randbytes(size)
                case 1:
                    data[at:at] = self._random.randbytes(size)
                case 2:
                    del data[at : at + size * self._random.choice((1, 100))]
                case 3:
                    data[at:at] = data[at : at + 1000]
                case 4:
                    data[at : at + 8] = b"\xff" * self._random.choice((4, 7, 8))
                case 5:
                    data[at : at + 8] = bytes(8)
                case 6 if self._random.random() < 0.2:
                    del data[at:]
        self._try(bytes(data), is_strict=False)

    def _try(self, data, *, is_strict):
        damage = self.damage
        path = self._folder / f"damaged_{damage.files}.mcap"
        path.write_bytes(data)
        damage.files += 1
        damage.damaged_bytes += len(data)
        began_s = time.process_time()
        try:
            self._read(path)
            self._recover(path, is_strict=is_strict)
        except Exception as error:
            damage.faults.append(f"{path.name}: {error!r}")
        took_s = time.process_time() - began_s
        damage.slowest_s = max(damage.slowest_s, took_s)
        if took_s > SLOW_S:
            damage.faults.append(f"{path.name}: it took {took_s:.1f} s")
        path.unlink()

    def _read(self, path):
        read = []
        try:
            read.extend(open_recording(path))  # what came before an error stays
        except RecordingError as error:
            self.damage.refused += 1
            if path.name not in str(error) or "byte" not in str(error):
                self._fault(path, f"an error without file or offset: {error}")
        else:
            if read != self._records:
                self._fault(path, "it was read to the end without a word, and differs")
        self._compare(path, read)

    def _recover(self, path, *, is_strict):
        output = path.with_name(f"out_{path.name}")
        try:
            report = recover(path, output)
        except RecordingError as error:
            self.damage.unsaved += 1
            if path.name not in str(error):
                self._fault(path, f"an error without the file: {error}")
            return
        back = list(open_recording(output))
        output.unlink()
        self._compare(path, back)
        saved = {record.sequence for record in back}
        lost = len(self._records) - len(saved)
        self.damage.saved_records += len(saved)
        self.damage.lost_records += lost
        self.damage.complete += report.complete
        if report.records != len(back):
            self._fault(path, f"{len(back)} records are there, the report says {report.records}")
        if is_strict and report.complete and lost:
            self._fault(path, f"{lost} records are lost, and the report says none")
        # Without a summary nobody knows what came after the last record that is there.
        known = max(saved, default=-1) + 1 - len(saved)
        if is_strict and report.missing_records not in (known, lost):
            self._fault(path, f"{lost} records are lost, the report says {report.missing_records}")

    def _compare(self, path, records):
        """Whatever is given must be what was recorded."""
        for record in records:
            if self._by_sequence.get(record.sequence) != record:
                self._fault(path, f"record {record.sequence} on {record.topic} is a wrong one")
                return

    def _fault(self, path, what):
        self.damage.faults.append(f"{path.name}: {what}")

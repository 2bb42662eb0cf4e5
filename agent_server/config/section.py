"""What every section of the settings has in common."""

from collections.abc import Iterator
from math import isfinite

import msgspec


class Contradiction(ValueError):
    """Values that do not go together.

    Attributes:
        sentences: Each names a key and what must hold.
    """

    def __init__(self, sentences: list[str]) -> None:
        super().__init__("; ".join(sentences))
        self.sentences = sentences


class Section(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Frozen values that refuse contradictions with a sentence for each."""

    def __post_init__(self) -> None:
        sentences = [
            f"{name} must be finite"
            for name in self.__struct_fields__
            if isinstance(value := getattr(self, name), float) and not isfinite(value)
        ]
        # What is not finite makes every comparison that follows meaningless.
        if sentences := sentences or list(self.contradictions()):
            raise Contradiction(sentences)

    def contradictions(self) -> Iterator[str]:
        """A sentence for each rule that these values break."""
        yield from ()


def unless(holds: bool, sentence: str) -> Iterator[str]:
    """The sentence, unless the rule holds."""
    if not holds:
        yield sentence

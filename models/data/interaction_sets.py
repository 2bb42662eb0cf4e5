"""Every set of interactions that both people's motion can be learnt from."""

from agent_server.errors import ConfigError
from models.data.duetdance import DUETDANCE
from models.data.interactions import K3HI, SBU, InteractionSet
from models.data.ntu_mutual import NTU_MUTUAL

TWO_PERSON_SETS: dict[str, InteractionSet] = {
    one.name: one for one in (SBU, K3HI, NTU_MUTUAL, DUETDANCE)
}


def two_person_set(name: str) -> InteractionSet:
    """A set by its name.

    Raises:
        ConfigError: If there is none of this name.
    """
    if name not in TWO_PERSON_SETS:
        raise ConfigError(f"set '{name}' is none of {', '.join(TWO_PERSON_SETS)}")
    return TWO_PERSON_SETS[name]

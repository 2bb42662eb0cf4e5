"""Rule files: read, checked, and refused with the line and the way out."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from functools import partial
from importlib import resources
from pathlib import Path

from agent_server.domain.command import Motion, Step
from agent_server.domain.gesture import GESTURES, IDLE
from agent_server.domain.scene import AgentMode, Authority
from agent_server.domain.stamp import NS_PER_MS, to_ns
from agent_server.errors import RuleError
from agent_server.scene.rulebook import (
    RESUME_WORK,
    Condition,
    IdleBehaviour,
    Reaction,
    Rule,
    Rules,
    SceneObject,
    StepKind,
)
from agent_server.scene.toml_reader import NAME_FIX, Source, Table, is_name
from agent_server.suggest import suggest

_TOP_PRIORITY = 1000


def default_rules(known_gestures: Collection[str] = GESTURES) -> Rules:
    """The rules of the room that comes with the product.

    Args:
        known_gestures: Labels of the classifier in use.

    Raises:
        RuleError: If the classifier lacks one of the built-in gestures.
    """
    text = resources.files(__package__).joinpath("room.toml").read_text(encoding="utf-8")
    return parse_rules(text, known_gestures, name="room.toml")


def load_rules(
    path: Path, known_gestures: Collection[str] = GESTURES, *, generates: bool = False
) -> Rules:
    """Read a rule file.

    Args:
        path: A TOML file in UTF-8.
        known_gestures: Labels of the classifier in use; a rule may name no others.
        generates: Whether there is a model that makes reactions; without one no rule asks for it.

    Raises:
        RuleError: If it cannot be read or something in it is wrong.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise RuleError(f"{path}: cannot be read ({error.strerror}); check the path") from error
    except UnicodeDecodeError as error:
        raise RuleError(
            f"{path}: not UTF-8 at byte {error.start}; save the file as UTF-8"
        ) from error
    return parse_rules(text, known_gestures, name=str(path), generates=generates)


def parse_rules(
    text: str,
    known_gestures: Collection[str] = GESTURES,
    *,
    name: str,
    generates: bool = False,
) -> Rules:
    """Check the text of a rule file.

    Args:
        text: The TOML document.
        known_gestures: Labels of the classifier in use; a rule may name no others.
        name: What messages call the file.
        generates: Whether there is a model that makes reactions; without one no rule asks for it.

    Raises:
        RuleError: On the first mistake: ``NAME:LINE: what is wrong; the way out``.
    """
    root = Source(name, text).parse()
    root.only("settings", "objects", "steps", "reactions", "rules", "idle")
    settings = root.table("settings").only("attention_s", "ungated", "authority")
    authority = _authority(settings, Authority.SERVER)
    objects = {
        key: _object(key, table, authority) for key, table in root.named_tables("objects").items()
    }
    kinds = {key: _step_kind(key, table) for key, table in root.named_tables("steps").items()}
    room = _Room(objects, kinds)
    reactions = {
        key: _reaction(key, table, room) for key, table in root.named_tables("reactions").items()
    }
    if RESUME_WORK not in reactions:
        raise root.error(
            "reactions",
            f"no reaction '{RESUME_WORK}'",
            f"add [reactions.{RESUME_WORK}], which is sent when attention ends",
        )
    return Rules(
        attention_s=settings.positive("attention_s"),
        ungated=_known_texts(settings, "ungated", "gesture", _gestures(known_gestures)),
        objects=objects,
        reactions=reactions,
        rules=_rules(root, known_gestures, reactions, room, generates=generates),
        idle=_idle(root, room),
    )


def _authority(table: Table, default: Authority) -> Authority:
    """Whose word holds, where the table says so."""
    if "authority" not in table:
        return default
    return Authority(_known(table, "authority", "side", list(Authority)))


def _object(name: str, table: Table, authority: Authority) -> SceneObject:
    table.only("states", "initial", "authority")
    states = table.texts("states")
    for index, state in enumerate(states):
        if state in states[:index]:
            raise table.element_error(
                "states", index, f"'{state}' is listed twice", "list each state once"
            )
        if not is_name(state):
            raise table.element_error("states", index, f"'{state}' is not a name", NAME_FIX)
    if "states" not in table and "initial" not in table:
        return SceneObject(name, (), None)
    if len(states) < 2:
        raise table.error(
            "states",
            f"an object that changes has two states or more, got {len(states)}",
            "add the others, or leave out states and initial",
        )
    initial = _known(table, "initial", "state", states)
    return SceneObject(name, tuple(states), initial, _authority(table, authority))


def _step_kind(name: str, table: Table) -> StepKind:
    table.only("duration_s", "target")
    return StepKind(name, table.positive("duration_s"), table.flag("target"))


def _known(table: Table, key: str, kind: str, known: Collection[str]) -> str:
    """The text at ``key``, after refusing what is not ``known``."""
    name = table.text(key)
    if name not in known:
        raise table.error(key, f"unknown {kind} '{name}'", suggest(name, f"{kind}s", known))
    return name


@dataclass(frozen=True, slots=True)
class _Room:
    """What steps and conditions are made of."""

    objects: Mapping[str, SceneObject]
    kinds: Mapping[str, StepKind]

    def step(self, text: str, error: Callable[[str, str], RuleError]) -> Step:
        """A step as a rule file writes it: ``stand_up`` or ``walk_to window``."""
        action, _, target = text.partition(" ")
        kind = self.kinds.get(action)
        if kind is None:
            raise error(f"unknown step '{action}'", suggest(action, "steps", self.kinds))
        if not kind.has_target and target:
            raise error(f"'{action}' has no target, got '{target}'", f'write "{action}"')
        if kind.has_target and target not in self.objects:
            what = f"unknown object '{target}'" if target else f"'{action}' needs a target"
            raise error(what, suggest(target, "objects", self.objects))
        return Step(action, target or None, kind.duration_s)

    def conditions(self, table: Table) -> tuple[Condition, ...]:
        """The states that a ``{ object = "state" }`` table names."""
        changing = {name: thing.states for name, thing in self.objects.items() if thing.states}
        for name in table.keys:
            if name not in changing:
                what = f"'{name}' has no states"
                if name not in self.objects:
                    what = f"unknown object '{name}'"
                raise table.error(name, what, suggest(name, "objects with states", changing))
        return tuple(
            Condition(name, _known(table, name, "state", changing[name])) for name in table.keys
        )


def _reaction(name: str, table: Table, room: _Room) -> Reaction:
    table.only("steps", "effects", "priority", "ttl_s")
    steps = tuple(
        room.step(text, partial(table.element_error, "steps", index))
        for index, text in enumerate(table.texts("steps"))
    )
    if not steps:
        raise table.error("steps", "a reaction has at least one step", 'add steps = ["...", ...]')
    return Reaction(
        name=name,
        steps=steps,
        effects=room.conditions(table.table("effects", required=False)),
        priority=table.integer("priority", _TOP_PRIORITY),
        ttl_ms=to_ns(table.positive("ttl_s")) // NS_PER_MS,
    )


def _rules(
    root: Table,
    known_gestures: Collection[str],
    reactions: Mapping[str, Reaction],
    room: _Room,
    *,
    generates: bool,
) -> dict[str, tuple[Rule, ...]]:
    gestures = _gestures(known_gestures)
    triggered = reactions.keys() - {RESUME_WORK}
    rules: dict[str, tuple[Rule, ...]] = {}
    for table in root.tables("rules"):
        table.only("gesture", "when", "reaction", "preempts", "motion")
        gesture = _known(table, "gesture", "gesture", gestures)
        if table.text("reaction") == RESUME_WORK:
            raise table.error(
                "reaction", f"'{RESUME_WORK}' is kept for the end of attention", "name another one"
            )
        rule = Rule(
            gesture=gesture,
            when=room.conditions(table.table("when", required=False)),
            reaction=reactions[_known(table, "reaction", "reaction", triggered)],
            preempts=_known_texts(table, "preempts", "reaction", triggered),
            motion=_motion(table),
        )
        if rule.motion is Motion.GENERATED and not generates:
            raise table.error(
                "motion",
                f"{rule.name} asks for a generated motion, and no model makes one",
                "name a bundle that reacts, reactions = 'FOLDER' in [models] of the settings, or "
                f'write motion = "{Motion.AUTHORED}"',
            )
        earlier = rules.get(gesture, ())
        for other in earlier:
            if set(other.when) <= set(rule.when):
                raise table.error(
                    "gesture",
                    f"this rule never applies: an earlier one, {other.name} "
                    f"({other.precondition or 'always'}), always goes first",
                    "put the rule with more conditions first, or remove one of them",
                )
        rules[gesture] = (*earlier, rule)
    return rules


def _motion(table: Table) -> Motion:
    if "motion" not in table:
        return Motion.AUTHORED
    return Motion(_known(table, "motion", "motion", list(Motion)))


def _gestures(known_gestures: Collection[str]) -> list[str]:
    """The gestures that a rule file may name."""
    return [gesture for gesture in known_gestures if gesture != IDLE]


def _known_texts(table: Table, key: str, kind: str, known: Collection[str]) -> frozenset[str]:
    """The texts listed at ``key``, after refusing any that is not ``known``."""
    names = table.texts(key)
    for index, name in enumerate(names):
        if name not in known:
            fix = suggest(name, f"{kind}s", known)
            raise table.element_error(key, index, f"unknown {kind} '{name}'", fix)
    return frozenset(names)


def _idle(root: Table, room: _Room) -> dict[AgentMode, tuple[IdleBehaviour, ...]]:
    modes = (AgentMode.WORKING, AgentMode.ATTENTION)
    idle = root.table("idle", required=False).only(*modes)
    behaviours = {}
    for mode in modes:
        table = idle.table(mode, required=False)
        behaviours[mode] = tuple(
            IdleBehaviour(room.step(text, partial(table.error, text)), table.positive(text))
            for text in table.keys
        )
    return behaviours

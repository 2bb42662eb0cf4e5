from pathlib import Path

import pytest

from agent_server.errors import RuleError
from agent_server.scene.rules import parse_rules

SMALL = Path(__file__).with_name("small_room.toml").read_text(encoding="utf-8")

# What is replaced, by what, which line the message names, and what it says.
MISTAKES = {
    "gesture": (
        '"point"',
        '"piont"',
        24,
        "unknown gesture 'piont'; did you mean 'point'? known gestures: point, shrug",
    ),
    "idle gesture": (
        '"point"',
        '"idle"',
        24,
        "unknown gesture 'idle'; known gestures: point, shrug",
    ),
    "ungated gesture": (
        "attention_s = 5\n",
        'attention_s = 5\nungated = ["point",\n"shurg"]\n',
        4,
        "settings.ungated[1]: unknown gesture 'shurg'; did you mean 'shrug'?",
    ),
    "ungated idle": (
        "attention_s = 5\n",
        'attention_s = 5\nungated = ["idle"]\n',
        3,
        "settings.ungated[0]: unknown gesture 'idle'; known gestures: point, shrug",
    ),
    "object in when": (
        "when = { lamp",
        "when = { lmap",
        25,
        (
            "rules[0].when.lmap: unknown object 'lmap'; did you mean 'lamp'? known "
            "objects with states: lamp"
        ),
    ),
    "object without states": (
        "when = { lamp",
        "when = { sofa",
        25,
        "rules[0].when.sofa: 'sofa' has no states; known objects with states: lamp",
    ),
    "state in when": (
        '{ lamp = "off" }',
        '{ lamp = "of" }',
        25,
        "unknown state 'of'; did you mean 'off'? known states: off, on",
    ),
    "state in effects": (
        'lamp = "on" }',
        'lamp = "red" }',
        14,
        "reactions.light.effects.lamp: unknown state 'red'; known states: off, on",
    ),
    "initial": (
        'initial = "off"',
        'initial = "dim"',
        5,
        "objects.lamp.initial: unknown state 'dim'",
    ),
    "step": (
        '"nod", "switch',
        '"nodd", "switch',
        13,
        (
            "reactions.light.steps[0]: unknown step 'nodd'; did you mean 'nod'? "
            "known steps: nod, switch"
        ),
    ),
    "empty step": (
        '"nod", "switch',
        '"", "switch',
        13,
        "unknown step ''; known steps: nod, switch",
    ),
    "step target": (
        '"switch lamp"',
        '"switch lap"',
        13,
        (
            "reactions.light.steps[1]: unknown object 'lap'; did you mean 'lamp'? "
            "known objects: lamp, sofa"
        ),
    ),
    "step without target": (
        '"switch lamp"',
        '"switch"',
        13,
        "'switch' needs a target; known objects: lamp, sofa",
    ),
    "step with needless target": (
        '["nod", ',
        '["nod sofa", ',
        13,
        "'nod' has no target, got 'sofa'; write \"nod\"",
    ),
    "reaction": (
        '"light"\npre',
        '"lihgt"\npre',
        26,
        "unknown reaction 'lihgt'; did you mean 'light'? known reactions: light",
    ),
    "preempts": (
        '["light"]',
        '["lite"]',
        27,
        "rules[0].preempts[0]: unknown reaction 'lite'; did you mean 'light'?",
    ),
    "resume_work in preempts": (
        '["light"]',
        '["resume_work"]',
        27,
        "rules[0].preempts[0]: unknown reaction 'resume_work'; known reactions: light",
    ),
    "no object with states": (
        'lamp = { states = ["on", "off"], initial = "off" }',
        "lamp = {}",
        14,
        "reactions.light.effects.lamp: 'lamp' has no states; known objects with states: none",
    ),
    "resume_work as a reaction": (
        '"light"\npre',
        '"resume_work"\npre',
        26,
        "'resume_work' is kept for the end of attention; name another one",
    ),
    "no resume_work": (
        "[reactions.resume_work]",
        "[reactions.rest]",
        12,
        "no reaction 'resume_work'; add [reactions.resume_work]",
    ),
    "unknown section": (
        "[settings]",
        "[setings]",
        1,
        (
            "setings: unknown key; did you mean 'settings'? known keys here: idle, "
            "objects, reactions, rules, settings, steps"
        ),
    ),
    "unknown key": (
        "priority = 3",
        "prioritty = 3",
        15,
        "reactions.light.prioritty: unknown key; did you mean 'priority'?",
    ),
    "missing key": (
        "priority = 3\n",
        "",
        12,
        "reactions.light.priority: missing; add priority = <a whole number>",
    ),
    "missing number": (
        "nod = { duration_s = 1 }",
        "nod = {}",
        9,
        "steps.nod.duration_s: missing; add duration_s = <a number>",
    ),
    "missing table": (
        "[settings]\nattention_s = 5\n",
        "",
        1,
        "settings: missing; add [settings]",
    ),
    "missing rules": (
        SMALL[SMALL.index("[[rules]]") :],
        "",
        1,
        "rules: missing; write each one under a line [[rules]]",
    ),
    "rules as a table": (
        "[[rules]]",
        "[rules]",
        23,
        "rules: is no list of tables; write each one under a line [[rules]]",
    ),
    "missing initial": (
        ', initial = "off"',
        "",
        5,
        "objects.lamp.initial: missing; add initial = <a text in quotes>",
    ),
    "missing states": (
        'states = ["on", "off"], ',
        "",
        5,
        (
            "objects.lamp.states: an object that changes has two states or more, got "
            "0; add the others, or leave out states and initial"
        ),
    ),
    "one state": (
        '["on", "off"]',
        '["off"]',
        5,
        "two states or more, got 1",
    ),
    "duplicate state": (
        '["on", "off"]',
        '["on", "off", "on"]',
        5,
        "objects.lamp.states[2]: 'on' is listed twice; list each state once",
    ),
    "state that is no name": (
        '["on", "off"]',
        '["on", "off", ""]',
        5,
        "objects.lamp.states[2]: '' is not a name; use 1 to 64 small letters",
    ),
    "object that is no name": (
        "sofa = {}",
        '"the sofa" = {}',
        6,
        "objects.the sofa: 'the sofa' is not a name; use 1 to 64 small letters",
    ),
    "no steps": (
        'steps = ["nod", "switch lamp"]',
        "steps = []",
        13,
        "a reaction has at least one step; add steps = [",
    ),
    "missing steps": (
        'steps = ["nod", "switch lamp"]\n',
        "",
        12,
        "reactions.light.steps: a reaction has at least one step",
    ),
    "text for a number": (
        "attention_s = 5",
        'attention_s = "5"',
        2,
        ("settings.attention_s: expected a number, got '5' (a text in quotes); write a number"),
    ),
    "flag for a number": (
        "attention_s = 5",
        "attention_s = true",
        2,
        "expected a number, got True (true or false)",
    ),
    "date for a number": (
        "attention_s = 5",
        "attention_s = 2024-01-01",
        2,
        "(a date or time); write a number",
    ),
    "number for a text": (
        '"point"',
        "7",
        24,
        "rules[0].gesture: expected a text in quotes, got 7 (a whole number)",
    ),
    "number for a list": (
        '["on", "off"]',
        "1.5",
        5,
        "expected a list in [brackets], got 1.5 (a number)",
    ),
    "number in a list": (
        '["light"]',
        "[7]",
        27,
        ('rules[0].preempts[0]: expected a text in quotes, got 7 (a whole number); write "text"'),
    ),
    "list for a table": (
        '{ lamp = "off" }',
        '["lamp"]',
        25,
        "rules[0].when: expected a table, got a list in [brackets]",
    ),
    "text for a table": (
        "sofa = {}",
        'sofa = "red"',
        6,
        "objects.sofa: expected a table, got 'red'",
    ),
    "fraction for a whole number": (
        "priority = 3",
        "priority = 3.5",
        15,
        "expected a whole number, got 3.5 (a number)",
    ),
    "flag for a whole number": (
        "priority = 3",
        "priority = true",
        15,
        "expected a whole number, got True",
    ),
    "number for a flag": (
        "target = true",
        "target = 1",
        10,
        "steps.switch.target: expected true or false, got 1 (a whole number)",
    ),
    "negative priority": (
        "priority = 3",
        "priority = -3",
        15,
        "-3 is out of range; choose from 0 to 1000",
    ),
    "negative time": (
        "attention_s = 5",
        "attention_s = -5",
        2,
        "settings.attention_s: -5 is out of range; choose from 0.001 to 86400",
    ),
    "no time": (
        "duration_s = 0.5",
        "duration_s = 0",
        10,
        "steps.switch.duration_s: 0 is out of range; choose from 0.001 to 86400",
    ),
    "endless time": (
        "ttl_s = 2.5",
        "ttl_s = inf",
        16,
        "inf is out of range; choose from 0.001 to 86400",
    ),
    "time that is none": (
        "ttl_s = 2.5",
        "ttl_s = nan",
        16,
        "nan is out of range; choose from 0.001 to 86400",
    ),
    "huge time": (
        "ttl_s = 2.5",
        "ttl_s = 1" + "0" * 400,
        16,
        "0 is out of range; choose from 0.001 to 86400",
    ),
    "duplicate key": (
        "priority = 3\n",
        "priority = 3\npriority = 4\n",
        16,
        "not valid TOML: Cannot overwrite a value; look there",
    ),
    "duplicate reaction": (
        "[reactions.resume_work]",
        "[reactions.light]",
        18,
        "not valid TOML: Cannot declare",
    ),
    "duplicate object": (
        "sofa = {}",
        "lamp = {}",
        6,
        "not valid TOML",
    ),
    "syntax": (
        '"point"',
        "point",
        24,
        "not valid TOML: Invalid value",
    ),
    "unclosed list": (
        '["light"]\n',
        '["light"\n\n',
        27,
        "not valid TOML: Unclosed array",
    ),
    "idle mode": (
        'preempts = ["light"]\n',
        'preempts = ["light"]\n[idle.resting]\n',
        28,
        "idle.resting: unknown key; known keys here: attention, working",
    ),
    "idle step": (
        'preempts = ["light"]\n',
        'preempts = ["light"]\n[idle.working]\n"nod sofa" = 1\n',
        29,
        "idle.working.nod sofa: 'nod' has no target",
    ),
    "idle weight": (
        'preempts = ["light"]\n',
        'preempts = ["light"]\n[idle.attention]\nnod = 0\n',
        29,
        "idle.attention.nod: 0 is out of range; choose from 0.001 to 86400",
    ),
    "same rule twice": (
        'preempts = ["light"]\n',
        (
            'preempts = ["light"]\n[[rules]]\ngesture = "point"\nwhen.lamp = '
            '"off"\nreaction = "light"\n'
        ),
        29,
        (
            "rules[1].gesture: this rule never applies: an earlier one, point -> "
            "light (lamp = off), always goes first; put the rule with more "
            "conditions first"
        ),
    ),
    "rule behind an unconditional one": (
        'when = { lamp = "off" }\nreaction = "light"',
        ('reaction = "light"\n[[rules]]\ngesture = "point"\nwhen.lamp = "off"\nreaction = "light"'),
        27,
        "an earlier one, point -> light (always), always goes first",
    ),
}


@pytest.mark.parametrize(("old", "new", "line", "message"), MISTAKES.values(), ids=MISTAKES)
def test_a_mistake_is_refused_with_its_line_and_the_way_out(old, new, line, message):
    assert old in SMALL
    with pytest.raises(RuleError) as refused:
        parse_rules(SMALL.replace(old, new, 1), ["point", "shrug", "idle"], name="my.toml")
    assert str(refused.value).startswith(f"my.toml:{line}: ")
    assert message in str(refused.value)

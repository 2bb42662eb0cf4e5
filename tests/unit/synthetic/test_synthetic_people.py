from dataclasses import asdict

import numpy as np

from agent_server.synthetic.corpus import people, subject_names
from agent_server.synthetic.person import Person, Placement


def test_a_name_is_the_same_person_whoever_else_is_there() -> None:
    few, many = people(3, ["v04"]), people(3, subject_names(8))
    assert few["v04"] == many["v04"]
    assert few["v04"] != people(4, ["v04"])["v04"]
    assert len({person.height_m for person in many.values()}) == 8


def test_a_population_has_human_proportions() -> None:
    group = list(people(0, subject_names(400)).values())
    heights = {sex: [p.height_m for p in group if p.sex == sex] for sex in ("female", "male")}
    assert abs(np.mean(heights["female"]) - 1.635) < 0.02
    assert abs(np.mean(heights["male"]) - 1.76) < 0.02
    left = np.mean([person.handedness == "left" for person in group])
    assert 0.06 < left < 0.17
    for person in group:
        # Fingertip to fingertip is about the stature.
        span = 2 * (person.shoulder_half_m + person.upper_arm_m + person.forearm_m + person.hand_m)
        assert 0.95 < span / person.height_m < 1.2
        assert all(value > 0 for value in asdict(person).values() if isinstance(value, float))


def test_placements_stay_in_front_of_the_sensor() -> None:
    rng = np.random.default_rng(0)
    places = [Placement.sample(rng) for _ in range(500)]
    assert all(1.2 <= place.distance_m <= 3.5 for place in places)
    assert all(abs(place.heading_rad) <= np.radians(45) for place in places)
    assert all(abs(place.lateral_m) <= 0.35 * place.distance_m + 1e-9 for place in places)
    assert 0.3 < np.mean([place.seated for place in places]) < 0.5
    assert Placement.sample(rng, seated=True).seated


def test_a_person_is_drawn_from_the_seed_alone() -> None:
    one, other = (Person.sample(np.random.default_rng(5), subject="x") for _ in range(2))
    assert one == other

"""What holds of labels whatever happens in front of the sensor."""

from itertools import pairwise

from hypothesis import event as note
from hypothesis import given, settings
from hypothesis import strategies as st

from agent_server.recording.director import MAX_GAP_NS, TakeDirector
from agent_server.recording.takes import Again, Count, Go, Taken, TakePlan
from tests.support.takes import NS, Person

happenings = st.lists(
    st.one_of(
        st.tuples(st.just("stay"), st.floats(5.0, 15.0)),
        st.tuples(st.just("stay"), st.floats(0.1, 5.0)),
        st.tuples(st.just("leave"), st.floats(0.1, 4.0)),
        st.tuples(st.just("refuse"), st.booleans()),
        st.tuples(st.just("hide"), st.booleans()),
        st.tuples(st.just("body"), st.integers(1, 3)),
    ),
    min_size=4,
    max_size=25,
)


class Noted(Person):
    """A person whose frames are kept."""

    def __init__(self, director):
        super().__init__(director)
        self.stamps = []

    def frame(self):
        if self.confidence:
            self.stamps.append(self.now_ns)
        return super().frame()


@settings(derandomize=True, deadline=None, max_examples=60)
@given(gesture=st.sampled_from(["wave", "idle"]), happenings=happenings)
def test_labels_lie_in_order_on_unbroken_frames_after_a_count_down(gesture, happenings):
    plan = TakePlan(gesture, "anna", 3, 2 * NS, NS // 2)
    anna = Noted(TakeDirector(plan))
    for what, how in happenings:
        match what:
            case "stay":
                anna.stay(how)
            case "leave":
                anna.leave(how)
            case "refuse":
                anna.is_willing = not how
            case "hide":
                anna.confidence = 0.0 if how else 1.0
            case "body":
                anna.body_id = how
    anna.hear(anna.director.stop())
    labels = anna.director.labels
    note(f"{len(labels)} labels of {gesture}")
    assert labels == [cue.label for cue in anna.said(Taken)]
    assert len(labels) <= 3 or gesture == "idle"
    end_ns = 0
    for label in labels:
        assert end_ns <= label.onset_ns < label.offset_ns <= anna.now_ns
        end_ns = label.offset_ns
        within = [at for at in anna.stamps if label.onset_ns <= at <= label.offset_ns]
        steps = [b - a for a, b in pairwise(within)]
        assert max(steps) <= MAX_GAP_NS
    told = anna.said(Count, Go, Taken, Again)
    for before, cue in zip([None, *told], told, strict=False):
        if isinstance(cue, Go):
            assert before == Count(cue.repetition, 1)
        if isinstance(cue, Taken | Again):
            assert isinstance(before, Go)
            assert before.repetition == cue.repetition

"""Ids of causes are published: in records, in files of CI and in scripts of others. None is ever renamed or removed."""

from hypcheck.record.lines import UNEXPLAINED
from hypcheck.runs.diagnosis import CAUSES

IDS = """
ring groove throat zero-coefficient interior-tangent-point interior-tangent-circle exterior-tangent-point
exterior-tangent-two-points exterior-tangent-osculating out-of-range lost-beside-the-ring lost-to-rounding
lost-outside-the-regime complex-pair-ignored repeated-root-beyond-a-pole root-at-upper-pole root-at-lower-pole
computed-roots imaginary-part-tolerance root-separation-tolerance float64-for-more half-the-digits always-0 always-1
always-minus-1 horizontal-gap centre-alone sides-exchanged alpha-gamma b-d alpha-b gamma-d x-z y-z x-ignored
y-ignored z-ignored x-for-y city-block chessboard z-below x-below z-from-the-bottom ball-of-b ball-of-d ball-around
ball-within half-spheroid double-spheroid half-waist gamma-is-alpha input-in-float32 input-in-float16 A-not-squared
B-not-squared Q-not-squared P-not-squared c0-sign-AB c1-sign-AB c1-without-AB c1-sign-A c1-without-A c1-sign-B
c1-without-B c1-sign-BP c1-without-BP c1-sign-AQ c1-without-AQ c2-sign-A c2-without-A c2-sign-B c2-without-B
c2-sign-1 c2-without-1 c2-sign-P c2-without-P c2-sign-Q c2-without-Q delta-sign-1 delta-without-1 delta-sign-2
delta-without-2 delta-sign-3 delta-without-3 delta-sign-4 delta-without-4 delta-sign-5 delta-without-5
delta-negative decision-c1 decision-c2 axis-ignored axis-level axis-towards-x axis-turned-back axis-y-negated
axis-x-y axis-y-z axis-x-z axis-sign axis-down degrees-as-radians radians-as-degrees half-angle double-angle
angle-from-the-plane small-angle axis-not-normalised axis-over-length axis-over-sum axis-over-greatest
axis-in-float32 direction-in-float32 axis-is-d tilted-b-d tilted-ball-around tilted-ball-within between-positions
sampled-times late-times early-times only-the-start only-the-end only-the-ends way-x-z way-b-d way-level way-always-0
way-always-1 times-from-the-end
"""
PUBLISHED = IDS.split()


def test_published_ids_of_causes_all_exist():
    assert set(PUBLISHED) <= {cause.name for cause in CAUSES}


def test_ids_of_causes_are_published_here_when_a_cause_is_added():
    assert {cause.name for cause in CAUSES} <= set(PUBLISHED)


def test_ids_of_causes_are_unique_and_need_no_quotes_in_a_shell():
    names = [cause.name for cause in CAUSES]
    assert len({name.casefold() for name in names} | {UNEXPLAINED}) == len(names) + 1
    assert all(name.replace("-", "").isascii() and name.replace("-", "").isalnum() for name in names)

"""BiGraphDiff: the name of an interaction in, the motion of both people out."""

"""InterFormer: an action of one person in, the reaction of another one out."""

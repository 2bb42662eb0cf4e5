"""How well a reaction goes with an action: it judges what is generated, and teaches nobody."""

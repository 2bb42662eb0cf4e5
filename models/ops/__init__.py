"""Differentiable twins of ``agent_server.geometry``, and what only training needs."""

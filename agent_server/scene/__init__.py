"""The agent's room: a rule file says what can happen, a state machine says what does."""

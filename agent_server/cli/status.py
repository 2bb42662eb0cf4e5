"""Exit statuses of the commands, as test runners have them."""

FAILED = 1
"""What was asked about was judged and does not hold: an expectation, a log, a file of settings."""
ERROR = 2
"""There is no answer: something could not be read, started or done. A wrong option ends so too."""
INTERRUPTED = 130
"""After SIGINT, as of a shell."""

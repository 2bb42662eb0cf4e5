"""Quality assurance: recordings with labels become tests, and tests become a report."""

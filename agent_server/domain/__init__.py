"""What the product talks about: frozen values over read-only arrays, without behaviour."""

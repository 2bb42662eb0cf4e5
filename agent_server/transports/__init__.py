"""Where the product meets the network."""

"""Back to MLP: the simple baseline that most motion predictors lose to."""

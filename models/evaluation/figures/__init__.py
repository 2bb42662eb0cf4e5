"""Figures of predictors side by side, each with a title that says what was found."""

"""Motion for training: one reader a data set, then windows and augmentation."""

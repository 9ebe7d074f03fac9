"""The explorer: a study on a local page whose sliders move its numbers."""

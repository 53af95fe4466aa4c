"""The explorer: a page for any browser, in which a launch is dragged and its motion is seen."""

"""What is told of results in words: a module for each few kinds, laid out alike."""

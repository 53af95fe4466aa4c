"""Forces and torques that friction takes up: the limit surface, and what holds a puck at rest."""

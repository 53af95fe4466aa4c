"""From tracks to friction: the puck and the launches under which a film is most likely."""

"""Arrays, parallel work, files and caches: nothing of physics."""

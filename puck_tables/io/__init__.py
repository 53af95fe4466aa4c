"""Results as files and tables of other programs: one neutral form, one file a format."""

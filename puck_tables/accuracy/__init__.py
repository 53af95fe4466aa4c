"""Methods, and what each costs and errs."""

"""The hot loop: equations of motion, steppers, events; everything compiled."""

"""The paper behind the model, reproduced: figures and claims from the program's functions."""

"""The paper's claims, and who judges them."""

"""The words of the explorer's page for questions to a database, in French."""

WORDS = {
    "cy.title": "Questions à la base de données",
    "cy.open": "Cypher",
    "cy.help.edit": "écrire son propre Cypher",
    "cy.help.ask": "demander",
    "cy.help.answer": "vers la réponse",
    "cy.help.jk": "question suivante, précédente ; Entrée l’ouvre",
    "cy.help.back": "quitter un champ ; puis retour à l’explorateur",
    "x.help.cypher": "questions à la base de données, en Cypher",
    "cy.says": "Les questions ne font que lire. Elles vont à la base telle qu’elle est maintenant ; l’explorateur montre "
    "ce qui s’y trouvait au démarrage du programme.",
    "cy.back": "Retour à l’explorateur",
    "cy.to.questions": "Vers les questions",
    "cy.to.text": "Vers votre propre Cypher",
    "cy.to.answer": "Vers la réponse",
    "cy.questions": "Questions fournies avec le programme",
    "cy.drawable": "avec image",
    "cy.needed": "nécessaire",
    "cy.ask": "Demander",
    "cy.edit": "Modifier son Cypher",
    "cy.shown": "Son Cypher",
    "cy.own": "Votre propre Cypher",
    "cy.limits": "Ce qui écrirait, chargerait des fichiers ou agirait sur le serveur est refusé. Le serveur a {seconds} "
    "secondes ; {rows} lignes au plus sont affichées.",
    "cy.names": "Les labels, relations et propriétés sont listés par",
    "cy.asking": "La base de données est interrogée …",
    "cy.rows.one": "{n} ligne",
    "cy.rows.many": "{n} lignes",
    "cy.more": "Seules les {n} premières lignes sont affichées : il y en a d’autres. Demandez-en moins, ou utilisez "
    "rosprivacy query avec --limit.",
    "cy.none": "Aucune ligne : rien dans la base de données n’y répond.",
    "cy.letters.one": "{n} caractère de plus",
    "cy.letters.many": "{n} caractères de plus",
    "cy.undrawn": "Pas d’image : ces lignes ne contiennent ni nœuds, ni relations, ni chemins, ou plus qu’on ne peut en "
    "dessiner.",
    "cy.drawn.all": "Ce que l’image montre, le tableau le dit en mots.",
    "cy.drawn.some": "Dessiné : seulement les premières lignes, {n} en tout. Le tableau dit en mots ce qui est dessiné, "
    "et davantage.",
    "cy.refused": "La question est restée sans réponse",
    "cy.busy": "{n} questions sont déjà en cours. Attendez que l’une soit terminée, puis demandez de nouveau.",
    "cy.warning": "Des lignes peuvent manquer",
    "cy.about": "Interroger la base de données",
    "cy.about.sources": "De quelles sources viennent les données ?",
    "cy.about.labels": "Que disent les labels à ce sujet ?",
    "cy.about.paths": "Les chemins de telles données vers une sortie, avec image",
    "cy.about.leak": "Qu’est-ce qui parvient encore à cette sortie ?",
}

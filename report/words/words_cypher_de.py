"""The words of the explorer's page for questions to a database, in German."""

WORDS = {
    "cy.title": "Fragen an die Datenbank",
    "cy.open": "Cypher",
    "cy.help.edit": "eigenes Cypher schreiben",
    "cy.help.ask": "fragen",
    "cy.help.answer": "zur Antwort",
    "cy.help.jk": "nächste, vorige Frage; Enter öffnet sie",
    "cy.help.back": "ein Feld verlassen; dann zurück zum Explorer",
    "x.help.cypher": "Fragen an die Datenbank, in Cypher",
    "cy.says": "Fragen lesen nur. Sie gehen an die Datenbank, wie sie jetzt ist; der Explorer zeigt, was beim Start des "
    "Programms darin stand.",
    "cy.back": "Zurück zum Explorer",
    "cy.to.questions": "Zu den Fragen",
    "cy.to.text": "Zum eigenen Cypher",
    "cy.to.answer": "Zur Antwort",
    "cy.questions": "Fragen, die das Programm mitbringt",
    "cy.drawable": "mit Bild",
    "cy.needed": "nötig",
    "cy.ask": "Fragen",
    "cy.edit": "Sein Cypher ändern",
    "cy.shown": "Das Cypher der Frage",
    "cy.own": "Eigenes Cypher",
    "cy.limits": "Was schreiben, Dateien laden oder auf den Server einwirken würde, wird abgelehnt. Der Server hat "
    "{seconds} Sekunden; höchstens {rows} Zeilen werden gezeigt.",
    "cy.names": "Labels, Beziehungen und Eigenschaften listet",
    "cy.asking": "Die Datenbank wird gefragt …",
    "cy.rows.one": "{n} Zeile",
    "cy.rows.many": "{n} Zeilen",
    "cy.more": "Nur die ersten {n} Zeilen werden gezeigt: Es gibt mehr. Fragen Sie nach weniger, oder nehmen Sie "
    "rosprivacy query mit --limit.",
    "cy.none": "Keine Zeilen: Nichts in der Datenbank entspricht der Frage.",
    "cy.letters.one": "{n} weiteres Zeichen",
    "cy.letters.many": "{n} weitere Zeichen",
    "cy.undrawn": "Kein Bild: Diese Zeilen enthalten keine Knoten, Beziehungen oder Pfade, oder mehr davon, als "
    "gezeichnet werden können.",
    "cy.drawn.all": "Was das Bild zeigt, sagt die Tabelle in Worten.",
    "cy.drawn.some": "Gezeichnet: nur die ersten Zeilen, {n} davon. Die Tabelle sagt in Worten, was gezeichnet ist, und "
    "mehr.",
    "cy.refused": "Die Frage wurde nicht beantwortet",
    "cy.busy": "{n} Fragen werden schon beantwortet. Warten Sie, bis eine fertig ist, und fragen Sie noch einmal.",
    "cy.warning": "Zeilen können fehlen",
    "cy.about": "Die Datenbank fragen",
    "cy.about.sources": "Aus welchen Quellen kommen die Daten?",
    "cy.about.labels": "Was sagen Labels darüber?",
    "cy.about.paths": "Die Wege solcher Daten zu Lecks, mit Bild",
    "cy.about.leak": "Was gelangt sonst zu diesem Leck?",
}
